#ifndef BATTEN_EXPERIMENTS_FAIRING_CHOICE_H_
#define BATTEN_EXPERIMENTS_FAIRING_CHOICE_H_

#include <string>
#include <vector>

#include "experiments/plot.h"
#include "problems/fit_problem.h"

namespace batten {

/// How the weight of a fairing term is found from the data.
/// gcv: the least V = (RSS / (m d)) / (1 - tr(H) / m)^2, H the hat matrix (Craven & Wahba 1979).
/// risk: the least RSS + 2 d noise^2 tr(H), the noise known: an unbiased estimate of the squared
/// error to the truth, but for a constant (Mallows 1973; Craven & Wahba 1979).
/// discrepancy: RSS = d noise^2 (m - tr(H)), the noise known (Morozov's principle with equivalent
/// degrees of freedom, Wahba 1983): the heaviest such weight; where chance leaves none, the one at
/// which the left side is the least multiple of the right one.
/// lcurve: the sharpest corner of log bend over log RSS (Hansen 1992), where the residuals keep a
/// twentieth of their degrees of freedom and are more than rounding.
enum class FairingRule { kGcv, kRisk, kDiscrepancy, kLCurve };
const char* ToString(FairingRule rule);
bool FromString(const std::string& text, FairingRule* rule);
/// What FairingSample::score is by the rule, for figures and summaries.
const char* ScoreName(FairingRule rule);
/// Whether the rule judges by a noise that must be given.
bool NeedsNoise(FairingRule rule);

struct FairingSample {
  double weight = 0.0;
  double residual = 0.0;  ///< RSS: energy of the term interpolation, in the user's units.
  double bend = 0.0;      ///< Energy of the fairing term at weight 1.
  double trace = 0.0;     ///< Effective number of control points, in the mean over coordinates.
  /// What the rule judges: V; (RSS / d + 2 noise^2 tr(H)) / (m noise^2); RSS / (d noise^2 (m -
  /// tr(H))); curvature of the L, NaN where that is left out.
  double score = 0.0;
};

struct FairingChoice {
  FairingRule rule = FairingRule::kGcv;
  double weight = 0.0;
  FairingSample chosen;  ///< That of the weight.
  /// Standard deviation of each coordinate that the residuals show, sqrt(RSS / (d (m - trace))), in
  /// the user's units; NaN where they have no freedom.
  double noise = 0.0;
  /// At which end of the scan the weight lies: -1 the data's, 1 the fair one, 0 at none.
  int end = 0;
  std::vector<FairingSample> samples;  ///< All that were tried, by weight: one solve each.
  double seconds = 0.0;                ///< Wall time of the choice, the problem's set-up included.
};
/// One sentence about a choice at an end of the scan or by discrepancy without an equality; else
/// empty.
std::string FairingChoiceWarning(const FairingChoice& choice);

/// Sets the weight of the one fairing term of `spec`, adding one of derivative 2 where there is
/// none. `noise`: standard deviation of each coordinate in the user's units, for risk and
/// discrepancy. Each sample costs one QR and one pass over R. Other terms, such as end_tangent,
/// pull at each weight but are no data: neither RSS nor trace nor m counts them. False with one
/// sentence in `error` for what the rule cannot judge: losses, terms and constraints that are not
/// linear, free or projected parameters, several fairing terms, a guard, which is one, as many
/// control points as points without any residual, an L without a corner, a noise that discrepancy
/// finds at no weight.
bool ChooseFairingWeight(const DataSet& data, FairingRule rule, double noise, FitSpec* spec,
                         FairingChoice* choice, std::string* error);

/// The curve of the choice: score over weight, RSS and trace beside it, and of lcurve the L itself;
/// the chosen weight is marked.
std::vector<PlotPanel> FairingChoicePanels(const FairingChoice& choice);

}  // namespace batten

#endif  // BATTEN_EXPERIMENTS_FAIRING_CHOICE_H_
