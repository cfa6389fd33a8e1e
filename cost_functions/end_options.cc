#include "cost_functions/end_options.h"

namespace batten {

OptionInfo EndOption() {
  return OptionInfo::Word("end", "both", {"both", "begin", "end"}, "which end of the domain");
}

void AddCoordinateOptions(const std::string& of_what, std::vector<OptionInfo>* options) {
  constexpr double kLowest = -1e150;
  for (const char* name : kCoordinateNames) {
    options->push_back(
        OptionInfo::Real(name, kNotGiven, kLowest, kNotGiven,
                         std::string("coordinate ") + name + of_what + "; inf: not given"));
  }
}

bool GivenCoordinates(const OptionValues& options, int dimension, Eigen::RowVectorXd* given,
                      std::string* beyond) {
  given->setConstant(dimension, kNotGiven);
  for (int c = 0; c < kMaxDimension; ++c) {
    const double value = options.Real(kCoordinateNames[c]);
    if (value == kNotGiven) continue;
    if (c >= dimension) {
      *beyond = kCoordinateNames[c];
      return false;
    }
    (*given)[c] = value;
  }
  return true;
}

}  // namespace batten
