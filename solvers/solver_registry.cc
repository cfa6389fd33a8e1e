#include "solvers/solver_registry.h"

#include <glog/logging.h>

#include "cost_functions/made_or_error.h"
#include "solvers/anderson.h"
#include "solvers/augmented_lagrangian.h"
#include "solvers/banded_cholesky.h"
#include "solvers/banded_qr.h"
#include "solvers/best_of.h"
#include "solvers/ceres_lbfgs.h"
#include "solvers/ceres_lm.h"
#include "solvers/cg.h"
#include "solvers/chebyshev_lspia.h"
#include "solvers/dense_qr.h"
#include "solvers/extended_pia.h"
#include "solvers/foot_iteration.h"
#include "solvers/foot_newton.h"
#include "solvers/gauss_seidel_pia.h"
#include "solvers/gim.h"
#include "solvers/irls.h"
#include "solvers/jacobi_pia.h"
#include "solvers/lbfgs.h"
#include "solvers/lm_schur.h"
#include "solvers/local_pia.h"
#include "solvers/lspia.h"
#include "solvers/mlspia.h"
#include "solvers/nesterov_lspia.h"
#include "solvers/newton.h"
#include "solvers/polyak_lspia.h"
#include "solvers/preconditioned_pia.h"
#include "solvers/randomised_pia.h"
#include "solvers/sor_pia.h"
#include "solvers/varpro.h"
#include "solvers/weighted_pia.h"

namespace batten {
namespace {

// The built-in solvers: one line each.
SolverEntry (*const kBuiltInSolvers[])() = {
    &MakeSolverEntry<BandedQrSolver>,
    &MakeSolverEntry<BandedCholeskySolver>,
    &MakeSolverEntry<DenseQrSolver>,
    &IrlsEntry,
    &MakeSolverEntry<NewtonSolver>,
    &MakeSolverEntry<GimSolver>,
    &MakeSolverEntry<WeightedPiaSolver>,
    &MakeSolverEntry<LocalPiaSolver>,
    &MakeSolverEntry<ExtendedPiaSolver>,
    &MakeSolverEntry<PreconditionedPiaSolver>,
    &LspiaEntry,
    &MakeSolverEntry<JacobiPiaSolver>,
    &MakeSolverEntry<GaussSeidelPiaSolver>,
    &MakeSolverEntry<SorPiaSolver>,
    &MakeSolverEntry<PolyakLspiaSolver>,
    &MakeSolverEntry<NesterovLspiaSolver>,
    &MakeSolverEntry<MlspiaSolver>,
    &MakeSolverEntry<ChebyshevLspiaSolver>,
    &MakeSolverEntry<RandomisedPiaSolver>,
    &AndersonEntry,
    &BestOfEntry,
    &AugmentedLagrangianEntry,
    &MakeSolverEntry<CgSolver>,
    &MakeSolverEntry<LbfgsSolver>,
    &MakeSolverEntry<CeresLbfgsSolver>,
    &MakeSolverEntry<CeresLmSolver>,
    &MakeSolverEntry<LmSchurSolver>,
    &MakeSolverEntry<FootNewtonSolver>,
    &MakeSolverEntry<VarproSolver>,
    &MakeSolverEntry<GiSolver>,
    &MakeSolverEntry<PdmSolver>,
    &MakeSolverEntry<TdmSolver>,
    &MakeSolverEntry<SdmSolver>,
};

}  // namespace

SolverRegistry& SolverRegistry::Global() {
  static SolverRegistry& registry = *[] {
    auto* made = new SolverRegistry;
    for (const auto make : kBuiltInSolvers) made->Register(make());
    return made;
  }();
  return registry;
}

void SolverRegistry::Register(SolverEntry entry) {
  const std::string name = entry.info.name;
  CHECK(entries_.emplace(name, std::move(entry)).second) << "two solvers are named " << name;
}

void SolverRegistry::Remove(const std::string& name) { entries_.erase(name); }

std::vector<std::string> SolverRegistry::Names() const {
  std::vector<std::string> names;
  for (const auto& [name, entry] : entries_) names.push_back(name);
  return names;
}

const SolverInfo* SolverRegistry::Find(const std::string& name) const {
  const auto found = entries_.find(name);
  return found == entries_.end() ? nullptr : &found->second.info;
}

std::string SolverRegistry::UsualName(const std::string& name) const {
  const std::string& base = Find(name)->usual_base;
  return base.empty() ? name : name + ":" + base;
}

std::unique_ptr<Solver> SolverRegistry::Make(const NameSpec& spec, OptionValues* options_used,
                                             std::string* error) const {
  const auto found = entries_.find(spec.name);
  if (found == entries_.end()) {
    *error = UnknownNameMessage("solver", spec.name, Names());
    return nullptr;
  }
  const SolverEntry& entry = found->second;
  if (entry.info.wraps_solver != (spec.wrapped != nullptr)) {
    *error = entry.info.wraps_solver
                 ? spec.name + " wraps a solver; write " + spec.name + ":SOLVER"
                 : spec.name + " wraps nothing; found :" + spec.wrapped->ToString();
    return nullptr;
  }
  OptionValues options;
  if (!ResolveOptions(entry.info.options, spec, &options, error)) return nullptr;
  std::unique_ptr<Solver> base;
  if (spec.wrapped != nullptr) {
    base = Make(*spec.wrapped, nullptr, error);
    if (base == nullptr) return nullptr;
  }
  if (options_used != nullptr) *options_used = options;
  return MadeOrError(
      "solver " + spec.name, [&] { return entry.make(options, std::move(base)); }, error);
}

}  // namespace batten
