#include <ceres/problem.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <memory>
#include <thread>

#include "cost_functions/term.h"
#include "experiments/conformance.h"
#include "experiments/conformance_fits.h"
#include "experiments/guarded_vector.h"
#include "experiments/run.h"
#include "experiments/taylor_slope.h"
#include "problems/objective.h"

namespace batten {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
constexpr double kAround = 0.05;  // of the box's side: how far test points are from the start

TermInfo InfoOf(const std::string& name) { return TermRegistry::Global().Find(name)->Info(); }

/// The term's defaults, each word of its own options, both ends of its numbers.
std::vector<std::string> OwnOptionTexts(const std::string& name) {
  std::vector<std::string> texts = {""};
  for (const OptionInfo& option : InfoOf(name).options) {
    std::vector<std::string> values = option.words;
    if (option.kind != OptionInfo::Kind::kWord) {
      for (const double value : {option.lowest, option.highest}) {
        if (std::isfinite(value)) values.push_back(NumberText(value));
      }
    }
    for (const std::string& value : values) texts.push_back("/" + option.name + "=" + value);
  }
  return texts;
}

/// The same and with losses.
std::vector<std::string> OptionTexts(const std::string& name) {
  std::vector<std::string> texts = OwnOptionTexts(name);
  for (const char* loss : {"huber", "cauchy", "soft_l1"}) {
    texts.push_back("/weight=1.5/loss=" + std::string(loss) + "/loss_scale=0.3");
  }
  return texts;
}

const BlockFamily& FamilyOf(const Problem& problem) { return *problem.terms().back().family; }

struct ValueAt {
  Status status = Status::kOk;
  double energy = 0.0;
  Eigen::VectorXd gradient;
};

ValueAt Evaluate(const BlockFamily& family, const Eigen::VectorXd& x) {
  ValueAt result;
  result.gradient = Eigen::VectorXd::Zero(x.size());
  result.status = family.Evaluate(x, 0, family.size(), &result.energy, &result.gradient);
  return result;
}

double EnergyAt(const BlockFamily& family, const Eigen::VectorXd& x) {
  double energy = 0.0;
  const Status status = family.Evaluate(x, 0, family.size(), &energy, nullptr);
  return status == Status::kOk ? energy : std::numeric_limits<double>::quiet_NaN();
}

/// Of length 1.
Eigen::VectorXd Direction(const Problem& problem, unsigned seed) {
  return (NearStart(problem, 1.0, seed) - problem.start()).normalized();
}

/// Calls check(name, problem), which gives the reason for a failure, on every problem that the term
/// can be formed for; the first reason, else how many it was.
template <typename Check>
CheckVerdict ForEachProblem(const std::string& name, const std::vector<std::string>& options,
                            Check check) {
  int count = 0;
  for (const std::string& option : options) {
    for (const ExampleProblem& example : ExampleProblemsOf(name + option, false)) {
      const std::string why = check(*example.problem);
      if (!why.empty()) return Failed(why + InText(name + option + ", " + example.name));
      ++count;
    }
  }
  if (count == 0) return Failed("it can be formed for none of the example fits");
  return {true, std::to_string(count) + " fits"};
}

CheckVerdict ChecksTermDescription(const std::string& name) {
  const TermInfo info = InfoOf(name);
  if (info.summary.empty() || info.summary.find('\n') != std::string::npos) {
    return Failed("its summary is not one line");
  }
  if (info.source.empty()) return Failed("it names no source");
  for (const OptionInfo& option : info.options) {
    if (option.help.empty()) return Failed("option " + option.name + " has no help");
    for (const OptionInfo& common : CommonTermOptions()) {
      if (common.name == option.name) return Failed("option " + option.name + " is every term's");
    }
  }
  return {true, "options: " + std::to_string(info.options.size())};
}

CheckVerdict ChecksTermOptions(const std::string& name) {
  NameSpec spec;
  const Term* term = nullptr;
  OptionValues values;
  std::string error;
  ParseNameSpec(name + "/no_such_option=1", &spec, &error);
  if (TermRegistry::Global().Resolve(spec, &term, &values, &error)) {
    return Failed("it takes an option that it has not announced");
  }
  return ForEachProblem(name, OwnOptionTexts(name), [](const Problem& problem) -> std::string {
    const double energy = EnergyAt(FamilyOf(problem), NearStart(problem, kAround, 1));
    return std::isfinite(energy) && energy >= 0.0 ? "" : "E is " + NumberText(energy);
  });
}

/// Slope of E(x + h v) - E(x) - h g'v.
TaylorSlope EnergySlope(const Problem& problem) {
  const BlockFamily& family = FamilyOf(problem);
  const Eigen::VectorXd x = NearStart(problem, kAround, 2);
  const Eigen::VectorXd v = Direction(problem, 3);
  const ValueAt at = Evaluate(family, x);
  const double slope = at.gradient.dot(v);
  const double noise = 1e3 * kEpsilon * (std::abs(at.energy) + std::abs(slope));
  return MeasureTaylorSlope(
      [&](double h) { return EnergyAt(family, x + h * v) - at.energy - h * slope; }, noise);
}

CheckVerdict ChecksGradient(const std::string& name) {
  double lowest = std::numeric_limits<double>::infinity();
  CheckVerdict verdict =
      ForEachProblem(name, OptionTexts(name), [&lowest](const Problem& problem) -> std::string {
        const TaylorSlope slope = EnergySlope(problem);
        if (slope.slope < lowest) lowest = slope.slope;
        if (IsRightDerivative(slope)) return "";
        return "the Taylor slope of E is " + NumberText(slope.slope) + ", must be 2";
      });
  if (verdict.passed && std::isfinite(lowest)) {
    verdict.detail += ", lowest Taylor slope " + std::to_string(lowest).substr(0, 4);
  }
  return verdict;
}

CheckVerdict ChecksHessian(const std::string& name) {
  // A loss with kinks in its second derivative has no Hessian there.
  return ForEachProblem(name, OwnOptionTexts(name), [](const Problem& problem) -> std::string {
    const BlockFamily& family = FamilyOf(problem);
    const Eigen::VectorXd x = NearStart(problem, kAround, 4);
    const Eigen::VectorXd v = Direction(problem, 5);
    const Eigen::VectorXd gradient = Evaluate(family, x).gradient;
    Eigen::VectorXd product = Eigen::VectorXd::Zero(x.size());
    if (family.AddHessianTimes(x, v, &product) != Status::kOk) return "H v has no value";
    // Products that are differences themselves are right to 2/3 of the digits.
    const double noise = 1e-9 * (gradient.norm() + product.norm()) + 1e3 * kEpsilon;
    const TaylorSlope slope = MeasureTaylorSlope(
        [&](double h) {
          return (Evaluate(family, x + h * v).gradient - gradient - h * product).norm();
        },
        noise);
    if (IsRightDerivative(slope)) return "";
    return "the Taylor slope of the gradient is " + NumberText(slope.slope) + ", must be 2";
  });
}

CheckVerdict ChecksResiduals(const std::string& name) {
  return ForEachProblem(name, OptionTexts(name), [](const Problem& problem) -> std::string {
    const BlockFamily& family = FamilyOf(problem);
    const Eigen::VectorXd x = NearStart(problem, kAround, 6);
    Eigen::VectorXd residuals;
    std::vector<Eigen::Triplet<double>> entries;
    if (family.Residuals(x, &residuals) != Status::kOk ||
        family.Jacobian(x, 0, &entries) != Status::kOk) {
      return "residuals have no value";
    }
    const int k = family.num_residuals();
    double energy = 0.0;
    Eigen::VectorXd factors(residuals.size());  // dE/dr / 2r
    for (int block = 0; block < family.size(); ++block) {
      const double square = residuals.segment(block * k, k).squaredNorm();
      double rho[3] = {square, 1.0, 0.0};
      if (family.loss() != nullptr) family.loss()->Evaluate(square, rho);
      energy += family.weight() * rho[0];
      factors.segment(block * k, k).setConstant(2.0 * family.weight() * rho[1]);
    }
    Eigen::VectorXd gradient = Eigen::VectorXd::Zero(x.size());
    for (const auto& entry : entries) {
      gradient[entry.col()] += factors[entry.row()] * residuals[entry.row()] * entry.value();
    }
    const ValueAt at = Evaluate(family, x);
    const double tolerance = 1e4 * kEpsilon;  // sums of some hundred products
    if (std::abs(at.energy - energy) > tolerance * (1.0 + energy)) {
      return "E is " + NumberText(at.energy) + ", its residuals say " + NumberText(energy);
    }
    const double off = (at.gradient - gradient).norm();
    if (off > tolerance * (1.0 + energy + gradient.norm())) {
      return "gradient and Jacobian differ by " + NumberText(off);
    }
    return "";
  });
}

CheckVerdict ChecksCompilation(const std::string& name) {
  return ForEachProblem(name, OwnOptionTexts(name), [&name](const Problem& problem) -> std::string {
    const BlockFamily& family = FamilyOf(problem);
    if (InfoOf(name).affine && family.loss() == nullptr && family.rows() == nullptr) {
      return "it says that it is affine and alike for all coordinates, but is not";
    }
    Objective compiled(&problem, nullptr), plain(&problem, nullptr, {false});
    Eigen::VectorXd x = compiled.start();
    x += 0.1 * Eigen::VectorXd::LinSpaced(x.size(), -kAround, kAround);
    double energies[2] = {0.0, 0.0};
    Eigen::VectorXd gradients[2];
    compiled.EnergyAndGradient(x, &energies[0], &gradients[0]);
    plain.EnergyAndGradient(x, &energies[1], &gradients[1]);
    const double tolerance = 1e4 * kEpsilon * (1.0 + energies[1] + gradients[1].norm());
    const double off = std::abs(energies[0] - energies[1]) + (gradients[0] - gradients[1]).norm();
    return off <= tolerance ? "" : "compiled rows differ by " + NumberText(off);
  });
}

std::string WhyCeresDiffers(const Problem& problem) {
  const BlockFamily& family = FamilyOf(problem);
  Eigen::VectorXd x = NearStart(problem, kAround, 7);
  const double energy = EnergyAt(family, x);
  ceres::Problem blocks;
  for (int block = 0; block < family.size(); ++block) {
    std::vector<int> offsets, sizes;
    family.Bind(x, block, &offsets, &sizes);
    std::vector<double*> pointers;
    for (const int offset : offsets) pointers.push_back(x.data() + offset);
    blocks.AddResidualBlock(family.MakeCeresCostFunction(x, block).release(),
                            family.MakeCeresLoss().release(), pointers);
  }
  double cost = 0.0;
  if (!blocks.Evaluate(ceres::Problem::EvaluateOptions(), &cost, nullptr, nullptr, nullptr)) {
    return "Ceres finds no value";
  }
  const double off = std::abs(2.0 * cost - energy);
  return off <= 1e4 * kEpsilon * (1.0 + energy) ? "" : "E and Ceres' differ by " + NumberText(off);
}

CheckVerdict ChecksCeres(const std::string& name) {
  return ForEachProblem(name, OptionTexts(name), &WhyCeresDiffers);
}

std::uint64_t BitsOf(double number) {
  std::uint64_t bits = 0;
  std::memcpy(&bits, &number, sizeof(bits));
  return bits;
}

bool SameBits(const ValueAt& a, const ValueAt& b) {
  return a.status == b.status && BitsOf(a.energy) == BitsOf(b.energy) &&
         a.gradient.size() == b.gradient.size() &&
         std::memcmp(a.gradient.data(), b.gradient.data(),
                     sizeof(double) * static_cast<std::size_t>(a.gradient.size())) == 0;
}

CheckVerdict ChecksRepeats(const std::string& name) {
  return ForEachProblem(name, OwnOptionTexts(name), [](const Problem& problem) -> std::string {
    const BlockFamily& family = FamilyOf(problem);
    const Eigen::VectorXd x = NearStart(problem, kAround, 8);
    const Eigen::VectorXd other = NearStart(problem, kAround, 9);
    const ValueAt first = Evaluate(family, x);
    if (first.status != Status::kOk) return "E has no value near the start";
    constexpr int kMany = 50;
    for (int call = 1; call <= kMany; ++call) {
      Evaluate(family, other);
      if (!SameBits(first, Evaluate(family, x))) {
        return "E or g at the same point differs at call " + std::to_string(2 * call + 1);
      }
    }
    double sum = 0.0;
    for (int block = 0; block < family.size(); ++block) {
      family.Evaluate(x, block, block + 1, &sum, nullptr);
    }
    return sum == EnergyAt(family, x) ? "" : "E is not the sum of its blocks in their order";
  });
}

CheckVerdict ChecksThreads(const std::string& name) {
  return ForEachProblem(name, OwnOptionTexts(name), [](const Problem& problem) -> std::string {
    const BlockFamily& family = FamilyOf(problem);
    constexpr unsigned kThreads = 3;
    constexpr int kCalls = 30;
    std::vector<ValueAt> alone(kThreads);
    std::vector<Eigen::VectorXd> points;
    for (unsigned t = 0; t < kThreads; ++t) {
      points.push_back(NearStart(problem, kAround, 10 + t));
      alone[t] = Evaluate(family, points[t]);
    }
    std::vector<char> same(kThreads, 1);
    std::vector<std::thread> threads;
    for (unsigned t = 0; t < kThreads; ++t) {
      threads.emplace_back([&, t] {
        for (int call = 0; call < kCalls; ++call) {
          if (!SameBits(alone[t], Evaluate(family, points[t]))) same[t] = 0;
        }
      });
    }
    for (std::thread& thread : threads) thread.join();
    const bool all = std::all_of(same.begin(), same.end(), [](char s) { return s != 0; });
    return all ? "" : "several threads at once find other values than one";
  });
}

CheckVerdict ChecksNonFinite(const std::string& name) {
  return ForEachProblem(name, OwnOptionTexts(name), [](const Problem& problem) -> std::string {
    const BlockFamily& family = FamilyOf(problem);
    const Eigen::VectorXd x = Eigen::VectorXd::Constant(problem.num_variables(), std::nan(""));
    const Status status = Evaluate(family, x).status;
    return status == Status::kNonFinite ? "" : "it gives an E where x is no number";
  });
}

CheckVerdict ChecksTermMemory(const std::string& name) {
  int count = 0;
  for (const ExampleProblem& example : PageSizedProblems(name)) {
    const BlockFamily& family = FamilyOf(*example.problem);
    GuardedVector x(NearStart(*example.problem, kAround / 10.0, 20));
    if (!x.works()) return {true, "not tried: this allocator leaves no place for a guard"};
    ValueAt ends[2];
    for (const int run : {0, 1}) {
      x.SetNumbersBehind(run == 0 ? 0.0 : std::nan(""));
      ends[run] = Evaluate(family, *x.vector());
    }
    if (!SameBits(ends[0], ends[1])) {
      return Failed("what stands behind the end of x changes E" + InText(example.name));
    }
    ++count;
  }
  return {true, std::to_string(count) + " fits"};
}

CheckVerdict ChecksFit(const std::string& name) {
  int count = 0;
  for (const ExampleProblem& example : ExampleProblemsOf(name + "/weight=0.01", true)) {
    RunSpec spec;
    spec.max_iterations = 500;
    spec.max_seconds = 5.0;
    NameSpec solver;
    RunResult result;
    std::string error;
    ParseNameSpec("lbfgs", &solver, &error);
    if (!Run(*example.problem, solver, spec, &result, &error)) return Failed(error);
    if (!result.skipped.empty()) return Failed(result.skipped + InText(example.name));
    const bool has_ended = IsSuccess(result.outcome.reason) ||
                           result.outcome.reason == StopReason::kLineSearchEnded ||
                           result.outcome.reason == StopReason::kIterationLimit;
    if (!has_ended || !(result.energy <= result.start_energy)) {
      return Failed(std::string("lbfgs ends with ") + ToString(result.outcome.reason) +
                    " at E = " + NumberText(result.energy) + InText(example.name));
    }
    ++count;
  }
  if (count == 0) return Failed("it stands beside the distance in none of the example fits");
  return {true, std::to_string(count) + " fits by lbfgs"};
}

}  // namespace

std::vector<ConformanceCheck> TermChecks(const std::string& registered) {
  const auto row = [&registered](const char* name, const char* what,
                                 CheckVerdict (*check)(const std::string&)) {
    return ConformanceCheck{name, what, [registered, check] { return check(registered); }};
  };
  return {
      row("description", "says what it is and where it is from, options with help",
          &ChecksTermDescription),
      row("options", "has an E at both ends and with each word of each option", &ChecksTermOptions),
      row("gradient", "g is that of E: the Taylor remainder falls with the square of the step",
          &ChecksGradient),
      row("Hessian", "H v is that of g, in the same way", &ChecksHessian),
      row("residuals", "E and g are those of residuals and Jacobian", &ChecksResiduals),
      row("compilation", "compiled rows give the same E and g as the functor", &ChecksCompilation),
      row("Ceres", "Ceres' own evaluation gives the same E", &ChecksCeres),
      row("repeatability", "gives the same bits at each call, E is the sum of its blocks",
          &ChecksRepeats),
      row("threads", "gives the same bits when three threads call it at once", &ChecksThreads),
      row("non-finite", "says so where there is no number", &ChecksNonFinite),
      row("memory", "reads nothing behind the end of x", &ChecksTermMemory),
      row("fit", "lbfgs lowers E with it beside the distance", &ChecksFit)};
}

}  // namespace batten
