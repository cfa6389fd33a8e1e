#ifndef BATTEN_SOLVERS_PLUGIN_CARD_H_
#define BATTEN_SOLVERS_PLUGIN_CARD_H_

#include <ceres/version.h>

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "cost_functions/block_family.h"
#include "cost_functions/fit_setting.h"
#include "cost_functions/term.h"
#include "problems/data_reader.h"
#include "problems/problem_registry.h"
#include "solvers/batten_c.h"
#include "solvers/plugin_registry.h"
#include "solvers/stepper.h"

#define BATTEN_TEXT_OF(x) #x
#define BATTEN_TEXT(x) BATTEN_TEXT_OF(x)

#if defined(__clang__)
#define BATTEN_COMPILER "Clang " BATTEN_TEXT(__clang_major__)
#elif defined(__GNUC__)
#define BATTEN_COMPILER "GCC " BATTEN_TEXT(__GNUC__)
#else
#define BATTEN_COMPILER "unknown"
#endif

#if defined(_GLIBCXX_DEBUG)
#define BATTEN_CXX_LIBRARY_MODE ", debug mode"
#else
#define BATTEN_CXX_LIBRARY_MODE ""
#endif
#if defined(__GLIBCXX__)
#define BATTEN_CXX_LIBRARY \
  "libstdc++, cxx11 ABI " BATTEN_TEXT(_GLIBCXX_USE_CXX11_ABI) BATTEN_CXX_LIBRARY_MODE
#elif defined(_LIBCPP_VERSION)
#define BATTEN_CXX_LIBRARY "libc++, ABI " BATTEN_TEXT(_LIBCPP_ABI_VERSION)
#else
#define BATTEN_CXX_LIBRARY "unknown"
#endif

namespace batten {

/// The card of whoever includes this. It has internal linkage and is a constant: an inline function
/// of a plugin may be taken from the program, which would then be compared with itself.
namespace {  // NOLINT(google-build-namespaces)

constexpr std::uint64_t ClassLayout() {
  std::uint64_t layout = 14695981039346656037ULL;
  for (const std::size_t size :
       {sizeof(void*),        sizeof(std::string), sizeof(Eigen::Index),  sizeof(Eigen::VectorXd),
        sizeof(Points),       sizeof(OptionInfo),  sizeof(OptionValues),  sizeof(NameSpec),
        sizeof(FitSetting),   sizeof(Sites),       sizeof(TermInfo),      sizeof(Term),
        sizeof(BlockFamily),  sizeof(DataSet),     sizeof(FitSpec),       sizeof(NamedProblem),
        sizeof(DataReader),   sizeof(Problem),     sizeof(CurveView),     sizeof(Objective),
        sizeof(SolverInfo),   sizeof(SolverEntry), sizeof(Outcome),       sizeof(Solver),
        sizeof(RunContext),   sizeof(Stepper),     sizeof(FixedPoint),    sizeof(CutRuleInfo),
        sizeof(CutRuleEntry), sizeof(CutRule),     sizeof(PluginRegistry)}) {
    layout = (layout ^ size) * 1099511628211ULL;  // FNV-1a
  }
  return layout;
}

// One for each file, on purpose. NOLINTNEXTLINE(misc-definitions-in-headers)
constexpr batten_card kThisCard = {
    sizeof(batten_card),
    BATTEN_API_LEVEL,
    "C++",
    BATTEN_COMPILER,
    BATTEN_CXX_LIBRARY,
    BATTEN_TEXT(EIGEN_WORLD_VERSION) "." BATTEN_TEXT(EIGEN_MAJOR_VERSION) "." BATTEN_TEXT(
        EIGEN_MINOR_VERSION),
    EIGEN_MAX_ALIGN_BYTES,
    EIGEN_DEFAULT_ALIGN_BYTES,
    Eigen::MatrixXd::IsRowMajor ? 1 : 0,
    CERES_VERSION_STRING,
    ClassLayout(),
};

}  // namespace

/// The fields of a card with their values, as the message that refuses one calls them.
using CardFields = std::vector<std::pair<std::string, std::string>>;
CardFields FieldsOf(const batten_card& card);
/// The card of the program.
CardFields HostCard();
/// Empty: a plugin with this card may be registered. Otherwise one sentence, which names the first
/// field that differs, with both values.
std::string WhyRefused(const batten_card& card);

}  // namespace batten

#endif  // BATTEN_SOLVERS_PLUGIN_CARD_H_
