#ifndef BATTEN_SOLVERS_FOOT_ITERATION_H_
#define BATTEN_SOLVERS_FOOT_ITERATION_H_

#include <memory>
#include <vector>

#include "solvers/foot_model.h"
#include "solvers/stall_guard.h"
#include "solvers/stepper.h"

namespace batten {

/// Methods that lower E(P) = the sum of squared distances of the points from the curve: foot
/// points, a step of the control points by a model of E there, foot points again. t of a free
/// problem is set to the feet.
class FootIteration : public FixedPoint {
 public:
  std::string WhyUnsupported(const Objective& objective) const override;
  std::vector<double> State() const override;
  void Restore(const std::vector<double>& state) override;
  Status Map(const Eigen::VectorXd& x, Eigen::VectorXd* g_of_x) final;
  /// Without the search for the new feet, unless a step's length depends on them.
  Status MapLeading(const Eigen::VectorXd& x, Eigen::VectorXd* g_of_x) final;
  Eigen::Index num_mapped(const Eigen::VectorXd& x) const final;
  /// Sets the parameters to the feet on the curve of the control points.
  Status Complete(Eigen::VectorXd* x) final;

 protected:
  /// `damping`: of the model, relative to its diagonal. With `search` a step is halved while E
  /// rises; where no part of it lowers E the run ends. kPoint searches where terms are not affine.
  FootIteration(FootModelKind kind, double damping, bool search)
      : kind_(kind), damping_(damping), search_(search) {}
  /// The control points' step at all variables. False where the model has none.
  virtual bool MakeStep(const Eigen::VectorXd& all, Eigen::VectorXd* step);
  FootModel* model() { return model_.get(); }

 private:
  std::optional<Outcome> DoStart(Eigen::VectorXd* x) override;
  std::optional<Outcome> Inspect(const Eigen::VectorXd& x, const Eigen::VectorXd& g_of_x) override;
  Status FindStep(const Eigen::VectorXd& x, Eigen::VectorXd* all, Eigen::VectorXd* step);
  Eigen::VectorXd MovedBy(const Eigen::VectorXd& all, const Eigen::VectorXd& step,
                          double part) const;
  Status Try(const Eigen::VectorXd& all, const Eigen::VectorXd& step, double part,
             Eigen::VectorXd* g_of_x, double* energy);

  FootModelKind kind_;
  double damping_;
  bool search_;
  bool searches_ = false;  // in this run
  std::unique_ptr<FootModel> model_;
  bool found_no_part_ = false;  // of the last step that lowers E
  StallGuard guard_;
};

/// Foot points, then a step of the geometric iteration. docs/solvers/gi.md.
class GiSolver final : public FootIteration {
 public:
  static SolverInfo ClassInfo();
  explicit GiSolver(const OptionValues& /*options*/)
      : FootIteration(FootModelKind::kPoint, 0.0, false) {}
  SolverInfo Info() const override { return ClassInfo(); }

 private:
  bool MakeStep(const Eigen::VectorXd& all, Eigen::VectorXd* step) override;
};

/// Point distance minimisation. docs/solvers/pdm.md.
class PdmSolver final : public FootIteration {
 public:
  static SolverInfo ClassInfo();
  explicit PdmSolver(const OptionValues& /*options*/)
      : FootIteration(FootModelKind::kPoint, 0.0, false) {}
  SolverInfo Info() const override { return ClassInfo(); }
};

/// Tangent distance minimisation. docs/solvers/tdm.md.
class TdmSolver final : public FootIteration {
 public:
  static SolverInfo ClassInfo();
  explicit TdmSolver(const OptionValues& options)
      : FootIteration(FootModelKind::kTangent, options.Real("damping"),
                      options.Word("search") == "halving") {}
  SolverInfo Info() const override { return ClassInfo(); }
};

/// Squared distance minimisation. docs/solvers/sdm.md.
class SdmSolver final : public FootIteration {
 public:
  static SolverInfo ClassInfo();
  explicit SdmSolver(const OptionValues& options)
      : FootIteration(FootModelKind::kCurvature, options.Real("damping"),
                      options.Word("search") == "halving") {}
  SolverInfo Info() const override { return ClassInfo(); }
};

}  // namespace batten

#endif  // BATTEN_SOLVERS_FOOT_ITERATION_H_
