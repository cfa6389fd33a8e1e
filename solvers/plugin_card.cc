#include "solvers/plugin_card.h"

#include <cstdio>
#include <cstring>

namespace batten {
namespace {

std::string TextOf(const char* text) { return text == nullptr ? "nothing" : text; }

std::string Hexadecimal(std::uint64_t number) {
  char digits[17];
  std::snprintf(digits, sizeof(digits), "%016llx", static_cast<unsigned long long>(number));
  return digits;
}

std::string Differs(const std::string& field, const std::string& found, const std::string& ours) {
  std::string advice = "; build it against this Batten";
  if (field == "Eigen alignment" || field == "Eigen packet size") {
    // Eigen's allocator goes by the packets of the processor, whatever the alignment is set to.
    advice =
        "; build it without -march=native, or with -DEIGEN_MAX_ALIGN_BYTES=16 "
        "-DEIGEN_DONT_VECTORIZE";
  } else if (field == "interface") {
    return "its interface is " + found + "; allowed: C++, C";
  }
  return "its " + field + " is " + found + ", this program's is " + ours + advice;
}

}  // namespace

CardFields FieldsOf(const batten_card& card) {
  CardFields fields = {{"card size", std::to_string(card.struct_size)},
                       {"API level", std::to_string(card.api_level)},
                       {"interface", TextOf(card.interface)}};
  if (std::strcmp(TextOf(card.interface).c_str(), "C") == 0) return fields;
  fields.insert(fields.end(),
                {{"compiler", TextOf(card.compiler)},
                 {"C++ library", TextOf(card.cxx_library)},
                 {"Eigen version", TextOf(card.eigen_version)},
                 {"Eigen alignment", std::to_string(card.eigen_alignment)},
                 {"Eigen packet size", std::to_string(card.eigen_packet)},
                 {"Eigen storage order", card.eigen_row_major != 0 ? "row-major" : "column-major"},
                 {"Ceres version", TextOf(card.ceres_version)},
                 {"class layout", Hexadecimal(card.class_layout)}});
  return fields;
}

CardFields HostCard() { return FieldsOf(kThisCard); }

std::string WhyRefused(const batten_card& card) {
  // A card of another size has other fields behind the first.
  if (card.struct_size != sizeof(batten_card)) {
    return Differs("card size", std::to_string(card.struct_size),
                   std::to_string(sizeof(batten_card)));
  }
  const CardFields found = FieldsOf(card);
  const CardFields ours = HostCard();
  for (std::size_t i = 0; i < found.size(); ++i) {
    const bool is_c = found[i].first == "interface" && found[i].second == "C";
    if (!is_c && found[i].second != ours[i].second) {
      return Differs(found[i].first, found[i].second, ours[i].second);
    }
  }
  return "";
}

}  // namespace batten
