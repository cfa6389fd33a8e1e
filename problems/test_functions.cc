#include "problems/test_functions.h"

#include <ceres/autodiff_cost_function.h>

#include <cmath>
#include <initializer_list>

#include "cost_functions/cost_function_family.h"

namespace batten {
namespace {

// Notation of More, Garbow and Hillstrom 1981, with indices from 0: x variables, f residuals.

struct Rosenbrock {
  template <typename T>
  bool operator()(const T* x, T* f) const {
    f[0] = 10.0 * (x[1] - x[0] * x[0]);
    f[1] = 1.0 - x[0];
    return true;
  }
};

struct FreudensteinRoth {
  template <typename T>
  bool operator()(const T* x, T* f) const {
    f[0] = -13.0 + x[0] + ((5.0 - x[1]) * x[1] - 2.0) * x[1];
    f[1] = -29.0 + x[0] + ((x[1] + 1.0) * x[1] - 14.0) * x[1];
    return true;
  }
};

struct PowellBadlyScaled {
  template <typename T>
  bool operator()(const T* x, T* f) const {
    using std::exp;
    f[0] = 1e4 * x[0] * x[1] - 1.0;
    f[1] = exp(-x[0]) + exp(-x[1]) - 1.0001;
    return true;
  }
};

struct BrownBadlyScaled {
  template <typename T>
  bool operator()(const T* x, T* f) const {
    f[0] = x[0] - 1e6;
    f[1] = x[1] - 2e-6;
    f[2] = x[0] * x[1] - 2.0;
    return true;
  }
};

struct Beale {
  template <typename T>
  bool operator()(const T* x, T* f) const {
    f[0] = 1.5 - x[0] * (1.0 - x[1]);
    f[1] = 2.25 - x[0] * (1.0 - x[1] * x[1]);
    f[2] = 2.625 - x[0] * (1.0 - x[1] * x[1] * x[1]);
    return true;
  }
};

struct HelicalValley {
  template <typename T>
  bool operator()(const T* x, T* f) const {
    using std::atan2;
    using std::sqrt;
    const T squared = x[0] * x[0] + x[1] * x[1];
    if (squared == T(0.0)) return false;  // on the axis there is no angle
    T turns = atan2(x[1], x[0]) / (2.0 * M_PI);
    // The function's angle jumps where x0 = 0 and x1 < 0; that of atan2 would at the start.
    if (x[0] < T(0.0) && x[1] < T(0.0)) turns += T(1.0);
    f[0] = 10.0 * (x[2] - 10.0 * turns);
    f[1] = 10.0 * (sqrt(squared) - 1.0);
    f[2] = x[2];
    return true;
  }
};

struct PowellSingular {
  template <typename T>
  bool operator()(const T* x, T* f) const {
    const T middle = x[1] - 2.0 * x[2];
    const T outer = x[0] - x[3];
    f[0] = x[0] + 10.0 * x[1];
    f[1] = std::sqrt(5.0) * (x[2] - x[3]);
    f[2] = middle * middle;
    f[3] = std::sqrt(10.0) * outer * outer;
    return true;
  }
};

struct Wood {
  template <typename T>
  bool operator()(const T* x, T* f) const {
    f[0] = 10.0 * (x[1] - x[0] * x[0]);
    f[1] = 1.0 - x[0];
    f[2] = std::sqrt(90.0) * (x[3] - x[2] * x[2]);
    f[3] = 1.0 - x[2];
    f[4] = std::sqrt(10.0) * (x[1] + x[3] - 2.0);
    f[5] = (x[1] - x[3]) / std::sqrt(10.0);
    return true;
  }
};

/// One of its 20 residuals, at t = 0.2, 0.4, ..., 4.
struct BrownDennis {
  template <typename T>
  bool operator()(const T* x, T* f) const {
    const T left = x[0] + t * x[1] - std::exp(t);
    const T right = x[2] + x[3] * std::sin(t) - std::cos(t);
    f[0] = left * left + right * right;
    return true;
  }
  double t;
};

struct Trigonometric {
  static constexpr int kSize = 10;
  template <typename T>
  bool operator()(const T* x, T* f) const {
    using std::cos;
    using std::sin;
    T sum(0.0);
    for (int j = 0; j < kSize; ++j) sum += 1.0 - cos(x[j]);
    for (int i = 0; i < kSize; ++i) {
      f[i] = sum + (i + 1.0) * (1.0 - cos(x[i])) - sin(x[i]);
    }
    return true;
  }
};

template <typename Functor, int kResiduals, int kVariables>
std::unique_ptr<BlockFamily> MakeOneBlock() {
  auto family = std::make_unique<CostFunctionFamily>();
  family->AddBlock(
      std::make_unique<ceres::AutoDiffCostFunction<Functor, kResiduals, kVariables>>(new Functor),
      {0});
  return family;
}

std::unique_ptr<BlockFamily> MakeBrownDennis() {
  auto family = std::make_unique<CostFunctionFamily>();
  for (int i = 1; i <= 20; ++i) {
    family->AddBlock(
        std::make_unique<ceres::AutoDiffCostFunction<BrownDennis, 1, 4>>(new BrownDennis{i / 5.0}),
        {0});
  }
  return family;
}

struct TableRow {
  TestFunction function;
  std::unique_ptr<BlockFamily> (*make)();
};

Eigen::VectorXd Vector(std::initializer_list<double> entries) {
  return Eigen::Map<const Eigen::VectorXd>(entries.begin(),
                                           static_cast<Eigen::Index>(entries.size()));
}

std::string Citation(int number) {
  return "More, Garbow, Hillstrom, \"Testing unconstrained optimization software\", ACM TOMS 7, "
         "1981, function " +
         std::to_string(number);
}

// Minima that the paper gives to a few digits are stated to all digits of a double. Those of
// powell_badly_scaled, brown_dennis and trigonometric were found by bisection and by Newton's
// method in extended precision (NumPy's longdouble, Python's decimal).
std::vector<TableRow> MakeTable() {
  const double root22 = std::sqrt(22.0);
  return {
      {{"rosenbrock", Vector({-1.2, 1.0}), {{Vector({1.0, 1.0}), 0.0}}, Citation(1)},
       &MakeOneBlock<Rosenbrock, 2, 2>},
      {{"freudenstein_roth",
        Vector({0.5, -2.0}),
        // The second: dE/dx0 = 0 leaves a cubic in x1 whose derivative is 3 x1^2 - 4 x1 - 6.
        {{Vector({5.0, 4.0}), 0.0},
         {Vector({15.0 + 4.0 * (2.0 - root22) / 3.0, (2.0 - root22) / 3.0}), 48.98425367924002}},
        Citation(2)},
       &MakeOneBlock<FreudensteinRoth, 2, 2>},
      {{"powell_badly_scaled",
        Vector({0.0, 1.0}),
        {{Vector({1.0981593296998175e-05, 9.106146739866524}), 0.0}},
        Citation(3)},
       &MakeOneBlock<PowellBadlyScaled, 2, 2>},
      {{"brown_badly_scaled", Vector({1.0, 1.0}), {{Vector({1e6, 2e-6}), 0.0}}, Citation(4)},
       &MakeOneBlock<BrownBadlyScaled, 3, 2>},
      {{"beale", Vector({1.0, 1.0}), {{Vector({3.0, 0.5}), 0.0}}, Citation(5)},
       &MakeOneBlock<Beale, 3, 2>},
      {{"helical_valley", Vector({-1.0, 0.0, 0.0}), {{Vector({1.0, 0.0, 0.0}), 0.0}}, Citation(7)},
       &MakeOneBlock<HelicalValley, 3, 3>},
      {{"powell_singular",
        Vector({3.0, -1.0, 0.0, 1.0}),
        {{Vector({0.0, 0.0, 0.0, 0.0}), 0.0}},
        Citation(13)},
       &MakeOneBlock<PowellSingular, 4, 4>},
      {{"wood",
        Vector({-3.0, -1.0, -3.0, -1.0}),
        {{Vector({1.0, 1.0, 1.0, 1.0}), 0.0}},
        Citation(14)},
       &MakeOneBlock<Wood, 6, 4>},
      {{"brown_dennis",
        Vector({25.0, 5.0, -5.0, -1.0}),
        {{Vector(
              {-11.594439904762165, 13.203630051207204, -0.40343948817685954, 0.2367787744557363}),
          85822.20162635634}},
        Citation(16)},
       &MakeBrownDennis},
      // Its start lies nearer to the second minimum than to the first.
      {{"trigonometric",
        Eigen::VectorXd::Constant(Trigonometric::kSize, 1.0 / Trigonometric::kSize),
        {{Eigen::VectorXd::Zero(Trigonometric::kSize), 0.0},
         {Vector({0.05515090398069129, 0.05684061679473856, 0.058764001762695084,
                  0.06099060865676081, 0.06362621369585451, 0.06684317945275879,
                  0.20816151856988116, 0.16436309588564774, 0.08500689568850744,
                  0.09143145071470794}),
          2.7950561218794566e-05}},
        Citation(26)},
       &MakeOneBlock<Trigonometric, Trigonometric::kSize, Trigonometric::kSize>},
  };
}

const std::vector<TableRow>& Table() {
  static const auto& table = *new std::vector<TableRow>(MakeTable());
  return table;
}

}  // namespace

std::vector<TestFunction> TestFunctions() {
  std::vector<TestFunction> functions;
  for (const TableRow& row : Table()) functions.push_back(row.function);
  return functions;
}

std::unique_ptr<Problem> MakeTestProblem(const std::string& name) {
  for (const TableRow& row : Table()) {
    if (row.function.name != name) continue;
    auto problem = std::make_unique<Problem>(name);
    problem->AddVariables("x", row.function.start);
    problem->AddTerm(name, row.make());
    return problem;
  }
  return nullptr;
}

}  // namespace batten
