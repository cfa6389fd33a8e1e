#ifndef BATTEN_PROBLEMS_FIT_PROBLEM_H_
#define BATTEN_PROBLEMS_FIT_PROBLEM_H_

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cost_functions/ordered_parameters.h"
#include "cost_functions/term.h"
#include "problems/data_set.h"
#include "problems/problem.h"
#include "splines/bspline_curve.h"
#include "splines/knot_rules.h"
#include "splines/parameterization.h"

namespace batten {

inline constexpr int kMaxControlPoints = 10'000'000;
/// Least longest side of the data's box, unless it is 0: squares of rounding errors of it are
/// normal numbers.
inline constexpr double kSmallestSpread = 1e-130;
/// The same for the largest of given weights times its square.
inline constexpr double kSmallestUnit = 1e-270;
/// Least of the largest weight of a term: with none there is nothing to fit.
inline constexpr double kSmallestTermWeight = 1e-30;

/// What the data's parameters are: given once and for all, variables beside the control points, or
/// always the foot points on the curve, whose control points are the only variables then.
enum class ParameterKind { kFixed, kFree, kProjected };
const char* ToString(ParameterKind kind);
bool FromString(const std::string& text, ParameterKind* kind);
/// The term that is the distance from the data of this kind and nothing else.
const char* DistanceTermOf(ParameterKind kind);

/// What is to be fitted to a data set; every field as in problem files and flags.
struct FitSpec {
  std::string name;
  int degree = 3;  // 1..kMaxDegree
  bool closed = false;
  int control_points = 0;  // open: degree + 1..kMaxControlPoints; closed: from 1
  /// Nothing: the data set's own column t.
  std::optional<Parameterization> parameters = Parameterization::kUniform;
  KnotRule knots = KnotRule::kUniform;
  EndKnots ends = EndKnots::kEndInterpolating;      // open only
  std::vector<double> given_knots;                  // not empty: instead of the rule
  std::optional<std::pair<double, double>> domain;  // with given parameters; default: their range,
                                                    // closed: [0, 1]
  std::vector<NameSpec> terms;                      // empty: interpolation; free: free_parameter;
                                                    // projected: foot_point
  /// data: on the polyline through the data; centroid: all in one point; circle, ellipse: around
  /// the data, of the size of their spread (principal axes).
  std::string start = "data";
  Points start_points;  // not empty: these instead, n x d, in user units
  ParameterKind parameter_kind = ParameterKind::kFixed;
  /// Free parameters of an open curve: those of the first and last data point stay at the ends of
  /// the domain.
  bool hold_ends = false;
  /// Free parameters: they stay in the order of the data points, on closed curves within a period.
  bool keep_order = false;
  /// Against loops: a name and options as in fit_guard.h. A problem made of it has the term
  /// instead. Nothing: none, but for fits as in robust_start.h, whose guard is estimated.
  std::optional<NameSpec> guard;
  std::vector<NameSpec> constraints;  // hard ones, of problems/curve_constraints.h
  /// Factors of fairing terms, one per non-empty span, finite and >= 0; empty: all 1.
  std::vector<double> span_weights;
};

/// The curve-fit side of a problem: data, spline space, parameters, and the map between the scaled
/// coordinates inside and the user's.
class CurveFit {
 public:
  const FitSpec& spec() const { return spec_; }
  /// Without the column t, which parameters() has taken over.
  const DataSet& data() const { return data_; }
  const BsplineBasis& basis() const { return *basis_; }
  const FitSetting& setting() const { return setting_; }
  /// t_i of data point i; of free ones where they start.
  const Eigen::VectorXd& parameters() const { return parameters_; }
  bool has_free_parameters() const { return setting_.parameter_offset >= 0; }
  bool is_projected() const { return spec_.parameter_kind == ParameterKind::kProjected; }
  /// t_i at all variables x, in the domain: of projected ones the feet.
  Eigen::VectorXd Parameters(const Eigen::VectorXd& x) const;
  /// With keep_order: the order of the variables t, but for ends that are held.
  OrderedParameters Order(const Eigen::VectorXd& t) const;
  /// The parameters that go with the variables t: themselves, or those in order if that is kept.
  Eigen::VectorXd OrderedIfKept(Eigen::VectorXd t) const;
  /// The start is Huber's answer (problems/robust_start.h).
  bool starts_robustly() const { return starts_robustly_; }
  int dimension() const { return static_cast<int>(data_.points.cols()); }
  /// Longest side of the data's box, in the user's units; 1 if all points are equal.
  double size() const { return size_; }
  /// Control points in the user's units of all variables x, and back.
  Points ControlPoints(const Eigen::VectorXd& x) const;
  Eigen::VectorXd Variables(const Points& control_points) const;
  /// All variables of control points and, where they are free, parameters.
  Eigen::VectorXd Variables(const Points& control_points, const Eigen::VectorXd& t) const;
  BsplineCurve Curve(const Eigen::VectorXd& x) const;

  CurveFit(const CurveFit&) = delete;
  CurveFit& operator=(const CurveFit&) = delete;

 private:
  friend std::unique_ptr<Problem> MakeFitProblem(DataSet, FitSpec, std::string*);
  CurveFit(DataSet data, FitSpec spec) : spec_(std::move(spec)), data_(std::move(data)) {}
  bool ChooseParameters(std::string* error);
  bool ChooseKnots(std::string* error);
  /// On the domain of the knots.
  bool PlaceParameters(std::string* error);
  bool Scale(std::string* error);
  /// Of the points with weight; `center` and `side` are their box's.
  double LargestDistanceFromMean(const Eigen::RowVectorXd& center, double side) const;
  bool CheckEnds(std::string* error) const;
  bool CheckKind(const NameSpec& name, const Term& term, std::string* error) const;
  bool CheckSpanWeights(std::string* error) const;
  /// Variables behind the control points, and the constraints that hold the ends.
  void AddParameters(Problem* problem, std::vector<LinearConstraint>* constraints);
  bool CheckStart(std::string* error) const;
  Eigen::VectorXd InOrder(Eigen::VectorXd t) const;
  Eigen::VectorXd FeetOf(const Eigen::VectorXd& x) const;
  Points StartPoints() const;
  Points StartOnPolyline() const;
  /// Free parameters start at the feet on a start curve that does not know the data's order.
  void StartParameters(const Points& start);

  FitSpec spec_;
  DataSet data_;
  std::optional<BsplineBasis> basis_;
  Eigen::VectorXd parameters_;
  bool starts_robustly_ = false;
  bool sorted_ = false;  // parameters_ are known not to decrease
  std::pair<double, double> domain_ = {0.0, 1.0};
  double size_ = 1.0;
  Sites sites_;
  FitSetting setting_;
};

/// Problem of `spec` over `data`: parameters, knots, scaling to the unit box (by a power of two),
/// terms and start. Null with one sentence in `error`: what was found, what is allowed.
std::unique_ptr<Problem> MakeFitProblem(DataSet data, FitSpec spec, std::string* error);

}  // namespace batten

#endif  // BATTEN_PROBLEMS_FIT_PROBLEM_H_
