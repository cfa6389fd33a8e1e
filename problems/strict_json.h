#ifndef BATTEN_PROBLEMS_STRICT_JSON_H_
#define BATTEN_PROBLEMS_STRICT_JSON_H_

#include <algorithm>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace batten {

/// Reads a whole JSON file. False with `FILE: line 3, column 5: ...` for anything that is not one
/// JSON value, for a key that stands twice in one object, and for a file that cannot be read.
bool ReadJsonFile(const std::string& path, nlohmann::json* json, std::string* error);

/// A JSON object that is read strictly: every getter checks type and range, and answers with false
/// and `FILE: /spline/degree: found 12; allowed: 1 to 9`. `json` and `error` must outlive it.
class StrictObject {
 public:
  /// What a key that is not there means: a refusal, or that the value stays as it is.
  enum class Presence { kRequired, kOptional };

  StrictObject() = default;
  /// `pointer` says where in the file the object stands: "" for the whole, else "/spline".
  StrictObject(std::string file, std::string pointer, const nlohmann::json* json,
               std::string* error);

  bool Has(const std::string& key) const { return Find(key) != nullptr; }
  /// False if there is any other key, naming the nearest known one; or if this is no object.
  bool HasOnly(const std::vector<std::string>& keys) const;

  bool Text(const std::string& key, Presence presence, std::string* value) const;  // one line
  bool Word(const std::string& key, Presence presence, const std::vector<std::string>& words,
            std::string* value) const;
  bool Flag(const std::string& key, Presence presence, bool* value) const;
  bool Integer(const std::string& key, Presence presence, int lowest, int highest,
               int* value) const;
  bool Number(const std::string& key, Presence presence, double lowest, double highest,
              double* value) const;
  /// Lists are not empty.
  bool Numbers(const std::string& key, Presence presence, std::vector<double>* values) const;
  bool Texts(const std::string& key, Presence presence, std::vector<std::string>* values) const;
  bool Object(const std::string& key, Presence presence, StrictObject* value) const;
  /// Whole numbers lowest..highest: a list of them, or one alone.
  bool Integers(const std::string& key, Presence presence, int lowest, int highest,
                std::vector<int>* values) const;
  /// The entries of a list, which need not be objects.
  bool Entries(const std::string& key, Presence presence, const std::string& allowed,
               std::vector<StrictObject>* entries) const;
  /// What stands at `key`, which need not be an object; the key has to be there.
  StrictObject Entry(const std::string& key) const;
  bool IsObject() const;
  /// What stands here is a text and no object.
  bool IsText(std::string* text) const;
  bool IsNumber(double* number) const;
  /// The keys of the object that stands here, in alphabetical order.
  std::vector<std::string> Keys() const;

  /// Whether no value of the list at `key`, as it was read, stands there twice; else the later one
  /// is refused.
  template <typename Value>
  bool IsWithoutRepeats(const std::string& key, const std::vector<Value>& values) const {
    for (std::size_t i = 0; i < values.size(); ++i) {
      const auto here = values.begin() + static_cast<std::ptrdiff_t>(i);
      if (std::find(values.begin(), here, values[i]) == here) continue;
      return Refuse(key + "/" + std::to_string(i), "each value once");
    }
    return true;
  }

  /// Whether `key` holds a list.
  bool IsList(const std::string& key) const;
  bool IsNumber(const std::string& key) const;
  /// False, with `FILE: POINTER/key: found ...; allowed: ` and `allowed`. `key` may go deeper:
  /// "terms/2", "control_points/2/0".
  bool Refuse(const std::string& key, const std::string& allowed) const;
  /// False, with `FILE: POINTER/key: ` and `sentence`.
  bool Complain(const std::string& key, const std::string& sentence) const;

 private:
  const nlohmann::json* Find(const std::string& key) const;
  /// True if `key` has a value to be read; otherwise *result is what the getter returns.
  bool IsThere(const std::string& key, Presence presence, const std::string& allowed,
               bool* result) const;

  std::string file_;
  std::string pointer_;
  const nlohmann::json* json_ = nullptr;
  std::string* error_ = nullptr;
};

}  // namespace batten

#endif  // BATTEN_PROBLEMS_STRICT_JSON_H_
