#include "problems/strict_json.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>

#include "cost_functions/options.h"
#include "problems/input_file.h"

namespace batten {
namespace {

using Json = nlohmann::json;

// ASCII and one line whatever stands in the file.
std::string Printable(std::string text) {
  const auto replaced = [](unsigned char c) { return c < 0x20 || c > 0x7e; };
  std::replace_if(text.begin(), text.end(), replaced, '?');
  return text;
}

std::string FoundText(const Json* value) {
  if (value == nullptr) return "nothing";
  if (value->is_array()) return value->empty() ? "an empty list" : "a list";
  if (value->is_object()) return "an object";
  constexpr std::size_t kLongest = 60;
  const std::string text = value->dump(-1, ' ', true);
  return text.size() <= kLongest ? text : text.substr(0, kLongest) + "...";
}

std::string RangeText(double lowest, double highest) {
  if (std::isinf(highest)) return "at least " + NumberText(lowest);
  return NumberText(lowest) + " to " + NumberText(highest);
}

/// Notes the first key that stands twice in its object, which the parser itself lets pass, and
/// where that object stands.
class RepeatedKeys {
 public:
  bool operator()(Json::parse_event_t event, const Json& parsed) {
    using Event = Json::parse_event_t;
    const bool begins = event == Event::object_start || event == Event::array_start;
    if ((begins || event == Event::value) && !open_.empty() && open_.back().is_list) {
      ++open_.back().entry;
    }
    if (begins) open_.push_back({event == Event::array_start, -1, "", {}});
    if (event == Event::object_end || event == Event::array_end) open_.pop_back();
    if (event == Event::key) NoteKey(parsed);
    return true;
  }
  /// `/spline: key "degree" stands twice`; empty: none does.
  const std::string& first() const { return first_; }
  /// Of the value behind what was parsed so far: "/spline/degree", "/a/2".
  std::string NextPlace() const {
    std::string place;
    for (std::size_t k = 0; k < open_.size(); ++k) {
      const Level& level = open_[k];
      const bool is_next = level.is_list && k + 1 == open_.size();
      place += "/" + (level.is_list ? std::to_string(level.entry + (is_next ? 1 : 0))
                                    : Printable(level.key));
    }
    return place.empty() ? "/" : place;
  }

 private:
  struct Level {
    bool is_list;
    int entry;
    std::string key;
    std::set<std::string> keys;
  };

  void NoteKey(const Json& key) {
    open_.back().key = key.get<std::string>();
    if (open_.back().keys.insert(open_.back().key).second || !first_.empty()) return;
    for (std::size_t k = 0; k + 1 < open_.size(); ++k) {
      const Level& level = open_[k];
      first_ += "/" + (level.is_list ? std::to_string(level.entry) : Printable(level.key));
    }
    first_ = (first_.empty() ? "/" : first_) + ": key " + FoundText(&key) + " stands twice";
  }

  std::vector<Level> open_;
  std::string first_;
};

}  // namespace

bool ReadJsonFile(const std::string& path, Json* json, std::string* error) {
  std::ifstream file(path);
  // A folder can be opened but not read.
  if (!file || file.peek() == std::ifstream::traits_type::eof()) {
    *error =
        path + (file.is_open() ? ": found nothing to read; allowed: a file with JSON text"
                               : ": found no such file that can be read" + NearestFileText(path));
    return false;
  }
  constexpr int kTooLarge = 406;  // of nlohmann::json::out_of_range
  RepeatedKeys keys;
  try {
    *json = Json::parse(file, [&keys](int /*depth*/, Json::parse_event_t event, Json& parsed) {
      return keys(event, parsed);
    });
  } catch (const Json::exception& problem) {
    // "[json.exception...] parse error at line 1, column 2: ...", or, of a number, without a place.
    const std::string what = problem.what();
    const std::size_t line = what.find("line ");
    const std::size_t quote = what.find('\'');
    if (line != std::string::npos) {
      *error = path + ": " + Printable(what.substr(line));
    } else if (problem.id == kTooLarge && quote != std::string::npos) {
      *error = path + ": " + keys.NextPlace() + ": found " +
               Printable(what.substr(quote + 1, what.rfind('\'') - quote - 1)) +
               "; allowed: numbers of at most " + NumberText(std::numeric_limits<double>::max());
    } else {
      *error = path + ":" + Printable(what.substr(what.find(']') + 1));
    }
    return false;
  }
  if (keys.first().empty()) return true;
  *error = path + ": " + keys.first() + "; allowed: once";
  return false;
}

StrictObject::StrictObject(std::string file, std::string pointer, const Json* json,
                           std::string* error)
    : file_(std::move(file)), pointer_(std::move(pointer)), json_(json), error_(error) {}

const Json* StrictObject::Find(const std::string& key) const {
  if (json_ == nullptr || !json_->is_object()) return nullptr;
  const auto found = json_->find(key);
  return found == json_->end() ? nullptr : &*found;
}

bool StrictObject::Complain(const std::string& key, const std::string& sentence) const {
  const std::string place = key.empty() && !pointer_.empty() ? pointer_ : pointer_ + "/" + key;
  *error_ = file_ + ": " + Printable(place) + ": " + sentence;
  return false;
}

bool StrictObject::Refuse(const std::string& key, const std::string& allowed) const {
  std::size_t slash = key.find('/');
  const Json* value = key.empty() ? json_ : Find(key.substr(0, slash));
  while (slash != std::string::npos) {  // entries of lists
    value = &value->at(std::stoul(key.substr(slash + 1)));
    slash = key.find('/', slash + 1);
  }
  return Complain(key, "found " + FoundText(value) + "; allowed: " + allowed);
}

bool StrictObject::IsThere(const std::string& key, Presence presence, const std::string& allowed,
                           bool* result) const {
  if (Has(key)) return true;
  *result = presence == Presence::kOptional || Refuse(key, allowed);
  return false;
}

bool StrictObject::HasOnly(const std::vector<std::string>& keys) const {
  if (!json_->is_object()) return Refuse("", "an object");
  for (const auto& item : json_->items()) {
    if (std::find(keys.begin(), keys.end(), item.key()) == keys.end()) {
      return Complain("", UnknownNameMessage("key", item.key(), keys));
    }
  }
  return true;
}

bool StrictObject::Text(const std::string& key, Presence presence, std::string* value) const {
  constexpr char kAllowed[] = "text on one line";
  bool result = true;
  if (!IsThere(key, presence, kAllowed, &result)) return result;
  if (!Find(key)->is_string()) return Refuse(key, kAllowed);
  const auto& text = Find(key)->get_ref<const std::string&>();
  const auto is_control = [](unsigned char c) { return c < 0x20 || c == 0x7f; };
  if (text.empty() || std::any_of(text.begin(), text.end(), is_control)) {
    return Refuse(key, kAllowed);
  }
  *value = text;
  return true;
}

bool StrictObject::Word(const std::string& key, Presence presence,
                        const std::vector<std::string>& words, std::string* value) const {
  std::string allowed;
  for (const std::string& word : words) allowed += (allowed.empty() ? "" : ", ") + word;
  bool result = true;
  if (!IsThere(key, presence, allowed, &result)) return result;
  const Json& word = *Find(key);
  if (!word.is_string()) return Refuse(key, allowed);
  if (std::find(words.begin(), words.end(), word) == words.end()) {
    return Refuse(key, allowed + "; did you mean " + NearestName(word, words) + "?");
  }
  *value = word.get<std::string>();
  return true;
}

bool StrictObject::Flag(const std::string& key, Presence presence, bool* value) const {
  bool result = true;
  if (!IsThere(key, presence, "true, false", &result)) return result;
  if (!Find(key)->is_boolean()) return Refuse(key, "true, false");
  *value = Find(key)->get<bool>();
  return true;
}

bool StrictObject::Integer(const std::string& key, Presence presence, int lowest, int highest,
                           int* value) const {
  const std::string allowed = std::to_string(lowest) + " to " + std::to_string(highest);
  bool result = true;
  if (!IsThere(key, presence, allowed, &result)) return result;
  const Json& number = *Find(key);
  if (!number.is_number_integer()) return Refuse(key, allowed + ", whole numbers");
  // As a double first: the file may hold more than an int does.
  const double wide = number.get<double>();
  if (wide < lowest || wide > highest) return Refuse(key, allowed);
  *value = number.get<int>();
  return true;
}

bool StrictObject::Number(const std::string& key, Presence presence, double lowest, double highest,
                          double* value) const {
  const std::string allowed = RangeText(lowest, highest);
  bool result = true;
  if (!IsThere(key, presence, allowed, &result)) return result;
  const Json& number = *Find(key);
  if (!number.is_number() || number.get<double>() < lowest || number.get<double>() > highest)
    return Refuse(key, allowed);
  *value = number.get<double>();
  return true;
}

bool StrictObject::IsList(const std::string& key) const {
  return Has(key) && Find(key)->is_array();
}

bool StrictObject::Numbers(const std::string& key, Presence presence,
                           std::vector<double>* values) const {
  bool result = true;
  if (!IsThere(key, presence, "a list of numbers", &result)) return result;
  if (!IsList(key) || Find(key)->empty()) return Refuse(key, "a list of numbers");
  std::vector<double> read;
  for (const Json& number : *Find(key)) {
    if (!number.is_number()) return Refuse(key + "/" + std::to_string(read.size()), "a number");
    read.push_back(number.get<double>());
  }
  *values = std::move(read);
  return true;
}

bool StrictObject::Texts(const std::string& key, Presence presence,
                         std::vector<std::string>* values) const {
  bool result = true;
  if (!IsThere(key, presence, "a list of texts", &result)) return result;
  if (!IsList(key) || Find(key)->empty()) return Refuse(key, "a list of texts");
  std::vector<std::string> read;
  for (const Json& text : *Find(key)) {
    if (!text.is_string()) return Refuse(key + "/" + std::to_string(read.size()), "text");
    read.push_back(text.get<std::string>());
  }
  *values = std::move(read);
  return true;
}

bool StrictObject::Object(const std::string& key, Presence presence, StrictObject* value) const {
  bool result = true;
  if (!IsThere(key, presence, "an object", &result)) return result;
  if (!Find(key)->is_object()) return Refuse(key, "an object");
  *value = StrictObject(file_, pointer_ + "/" + key, Find(key), error_);
  return true;
}

bool StrictObject::Integers(const std::string& key, Presence presence, int lowest, int highest,
                            std::vector<int>* values) const {
  if (!IsList(key)) {
    int value = 0;
    if (!Integer(key, presence, lowest, highest, &value)) return false;
    if (Has(key)) *values = {value};
    return true;
  }
  std::vector<double> numbers;
  if (!Numbers(key, presence, &numbers)) return false;
  std::vector<int> read;
  for (const double number : numbers) {
    if (number != std::trunc(number) || number < lowest || number > highest) {
      return Refuse(key + "/" + std::to_string(read.size()),
                    std::to_string(lowest) + " to " + std::to_string(highest) + ", whole numbers");
    }
    read.push_back(static_cast<int>(number));
  }
  *values = std::move(read);
  return true;
}

bool StrictObject::Entries(const std::string& key, Presence presence, const std::string& allowed,
                           std::vector<StrictObject>* entries) const {
  bool result = true;
  if (!IsThere(key, presence, allowed, &result)) return result;
  if (!IsList(key) || Find(key)->empty()) return Refuse(key, allowed);
  for (const Json& entry : *Find(key)) {
    const std::string place = pointer_ + "/" + key + "/" + std::to_string(entries->size());
    entries->emplace_back(file_, place, &entry, error_);
  }
  return true;
}

StrictObject StrictObject::Entry(const std::string& key) const {
  return {file_, pointer_ + "/" + key, Find(key), error_};
}

bool StrictObject::IsObject() const { return json_ != nullptr && json_->is_object(); }

bool StrictObject::IsText(std::string* text) const {
  if (json_ == nullptr || !json_->is_string()) return false;
  *text = json_->get<std::string>();
  return true;
}

bool StrictObject::IsNumber(double* number) const {
  if (json_ == nullptr || !json_->is_number()) return false;
  *number = json_->get<double>();
  return true;
}

bool StrictObject::IsNumber(const std::string& key) const {
  return Has(key) && Find(key)->is_number();
}

std::vector<std::string> StrictObject::Keys() const {
  std::vector<std::string> keys;
  if (json_ == nullptr || !json_->is_object()) return keys;
  for (const auto& item : json_->items()) keys.push_back(item.key());
  return keys;
}

}  // namespace batten
