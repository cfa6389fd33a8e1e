#ifndef BATTEN_COST_FUNCTIONS_TERM_H_
#define BATTEN_COST_FUNCTIONS_TERM_H_

#include <memory>
#include <string>
#include <vector>

#include "cost_functions/block_family.h"
#include "cost_functions/fit_setting.h"
#include "cost_functions/options.h"

namespace batten {

struct TermInfo {
  std::string name;
  std::string summary;              ///< One line.
  std::string source;               ///< Where it is from.
  bool affine = false;              ///< Residual affine in the control points, coordinates alike.
  std::vector<OptionInfo> options;  ///< Its own; every term also has CommonTermOptions().
  bool free_parameters = false;     ///< Needs parameters that are variables.
  bool foot_points = false;         ///< Needs parameters that are projected: always foot points.
};

/// weight=1, loss=none|huber|cauchy|tukey|soft_l1, loss_scale=1 (in units of the data's size).
std::vector<OptionInfo> CommonTermOptions();

/// What is registered: makes the blocks of one named term for one fit.
class Term {
 public:
  virtual ~Term() = default;
  virtual TermInfo Info() const = 0;
  /// `setting` and what it points to must outlive the family. Options are those of Info() and
  /// CommonTermOptions(). Null with one sentence in `error` where the term cannot be formed.
  virtual std::unique_ptr<BlockFamily> MakeFamily(const FitSetting& setting,
                                                  const OptionValues& options,
                                                  std::string* error) const = 0;
};

/// All registered terms, by name; built-in ones come from the table in term_registry.cc.
/// term.MakeFamily(); what it throws, but for want of memory, is its error.
std::unique_ptr<BlockFamily> MakeFamilyOf(const Term& term, const FitSetting& setting,
                                          const OptionValues& options, std::string* error);

class TermRegistry {
 public:
  static TermRegistry& Global();
  void Register(std::unique_ptr<Term> term);
  std::vector<std::string> Names() const;
  /// Null for an unknown name.
  const Term* Find(const std::string& name) const;
  /// Term and checked options of `spec`; false with one sentence in `error`.
  bool Resolve(const NameSpec& spec, const Term** term, OptionValues* options,
               std::string* error) const;

 private:
  std::map<std::string, std::unique_ptr<Term>> terms_;
};

}  // namespace batten

#endif  // BATTEN_COST_FUNCTIONS_TERM_H_
