#include "experiments/audit_equations.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "experiments/audit_sums.h"

namespace batten {
namespace {

using Real = CoupledEquations::Real;
using Row = std::vector<Real>;

Real RowProduct(const Row& a, const Row& b) {
  return std::inner_product(a.begin(), a.end(), b.begin(), Real(0));
}

/// Twice: once loses the digits that cancel.
void RemoveParts(const CoupledEquations::Rows& orthonormal, Row* row) {
  for (int pass = 0; pass < 2; ++pass) {
    for (const Row& unit : orthonormal) {
      const Real part = RowProduct(unit, *row);
      for (std::size_t k = 0; k < row->size(); ++k) (*row)[k] -= part * unit[k];
    }
  }
}

Row Gather(const std::vector<Real>& all, const std::vector<std::size_t>& entries) {
  Row row;
  for (const std::size_t e : entries) row.push_back(all[e]);
  return row;
}

}  // namespace

EquationRow MakeEquationRow(const AuditedFit& fit, const AuditedEquation& equation,
                            AuditCurve* curve) {
  EquationRow made;
  std::vector<Real> row;
  std::vector<Real> sizes;
  for (const AuditedEquation::Part& part : equation.parts) {
    curve->MoveTo(part.t);
    curve->DerivativeRow(part.derivative, &row, &sizes);
    for (int j = 0; j <= fit.degree; ++j) {
      for (int c = 0; c < fit.dimension; ++c) {
        const Real factor = part.factor * static_cast<Real>(equation.direction[c]);
        if (factor == 0 || sizes[j] == 0) continue;
        const auto entry = static_cast<std::size_t>(curve->ControlPoint(j) * fit.dimension + c);
        made.row[entry] += factor * row[j];
        made.sizes[entry] += std::abs(factor) * sizes[j];
      }
    }
  }
  return made;
}

std::vector<std::vector<std::size_t>> GroupCoupled(const std::vector<EquationRow>& rows) {
  std::vector<std::size_t> parent(rows.size());
  std::iota(parent.begin(), parent.end(), std::size_t{0});
  const auto root = [&parent](std::size_t k) {
    while (parent[k] != k) k = parent[k];
    return k;
  };
  std::map<std::size_t, std::size_t> first_with;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    for (const auto& [entry, coefficient] : rows[k].row) {
      const auto [known, is_new] = first_with.emplace(entry, k);
      if (!is_new) parent[root(k)] = root(known->second);
    }
  }
  std::map<std::size_t, std::vector<std::size_t>> groups;
  for (std::size_t k = 0; k < rows.size(); ++k) groups[root(k)].push_back(k);
  std::vector<std::vector<std::size_t>> made;
  for (auto& [unused, group] : groups) made.push_back(std::move(group));
  return made;
}

CoupledEquations::CoupledEquations(const std::vector<const EquationRow*>& equations,
                                   const std::vector<bool>& eliminated) {
  std::map<std::size_t, std::size_t> place;
  for (const EquationRow* equation : equations) {
    for (const auto& [entry, coefficient] : equation->row) place.emplace(entry, 0);
  }
  for (auto& [entry, k] : place) {
    k = entries_.size();
    if (eliminated[entry]) pivots_.push_back(k);
    entries_.push_back(entry);
  }
  for (const EquationRow* equation : equations) {
    Row row(entries_.size(), 0);
    Row sizes = row;
    for (const auto& [entry, coefficient] : equation->row) row[place[entry]] = coefficient;
    for (const auto& [entry, size] : equation->sizes) sizes[place[entry]] = size;
    const Real length = std::sqrt(RowProduct(row, row));
    for (std::size_t k = 0; k < row.size() && length > 0; ++k) {
      row[k] /= length;
      sizes[k] /= length;
    }
    rows_.push_back(std::move(row));
    sizes_.push_back(std::move(sizes));
  }
  ChooseIndependent(pivots_.size());
  if (failure_.empty()) Invert();
}

void CoupledEquations::ChooseIndependent(std::size_t num_eliminated) {
  // The run computes in double, and takes a row for a combination of others where no more than some
  // roundings are left of it; here rows are known to 1e-18 or so.
  constexpr Real kDependent = 1e-16L;
  constexpr Real kIndependent = 1e-12L;
  Rows left = rows_;
  Rows rows, sizes;
  const auto length = [](const Row& row) { return std::sqrt(RowProduct(row, row)); };
  const auto next = [&] {
    return std::max_element(left.begin(), left.end(),
                            [&](const Row& a, const Row& b) { return length(a) < length(b); });
  };
  bool is_short = false;
  while (orthonormal_.size() < num_eliminated && !is_short) {
    const auto chosen = next();
    is_short = chosen == left.end() || !(length(*chosen) > kDependent);
    if (is_short) break;
    const auto at = chosen - left.begin();
    Row unit = *chosen;
    RemoveParts(orthonormal_, &unit);
    const Real unit_length = length(unit);
    for (Real& value : unit) value /= unit_length;
    rows.push_back(rows_[at]);
    sizes.push_back(sizes_[at]);
    rows_.erase(rows_.begin() + at);
    sizes_.erase(sizes_.begin() + at);
    left.erase(chosen);
    for (Row& row : left) RemoveParts({unit}, &row);
    orthonormal_.push_back(std::move(unit));
  }
  if (is_short || (!left.empty() && length(*next()) > kIndependent)) {
    failure_ = "takes " + std::to_string(num_eliminated) +
               " coordinates of control points from linear constraints, of which " +
               (is_short ? "only " + std::to_string(orthonormal_.size()) + " are independent"
                         : "more are independent");
  }
  rows_ = std::move(rows);
  sizes_ = std::move(sizes);
}

/// Gauss-Jordan with row pivots.
void CoupledEquations::Invert() {
  const std::size_t n = pivots_.size();
  Rows a;
  for (const Row& row : rows_) a.push_back(Gather(row, pivots_));
  inverse_.assign(n, Row(n, 0));
  for (std::size_t k = 0; k < n; ++k) inverse_[k][k] = 1;
  for (std::size_t k = 0; k < n; ++k) {
    std::size_t best = k;
    for (std::size_t r = k + 1; r < n; ++r) {
      if (std::abs(a[r][k]) > std::abs(a[best][k])) best = r;
    }
    std::swap(a[k], a[best]);
    std::swap(inverse_[k], inverse_[best]);
    if (a[k][k] == 0) {
      failure_ =
          "takes coordinates of control points from linear constraints that do not hold them";
      return;
    }
    const Real pivot = a[k][k];
    for (std::size_t c = 0; c < n; ++c) {
      a[k][c] /= pivot;
      inverse_[k][c] /= pivot;
    }
    for (std::size_t r = 0; r < n; ++r) {
      const Real factor = a[r][k];
      if (r == k || factor == 0) continue;
      for (std::size_t c = 0; c < n; ++c) {
        a[r][c] -= factor * a[k][c];
        inverse_[r][c] -= factor * inverse_[k][c];
      }
    }
  }
}

void CoupledEquations::Project(std::vector<Real>* gradient) const {
  Row own = Gather(*gradient, entries_);
  RemoveParts(orthonormal_, &own);
  for (std::size_t k = 0; k < entries_.size(); ++k) (*gradient)[entries_[k]] = own[k];
}

void CoupledEquations::Reduce(std::vector<Real>* gradient, std::vector<Real>* rounding) const {
  const std::size_t n = pivots_.size();
  Row g = Gather(*gradient, entries_);
  Row error = Gather(*rounding, entries_);
  Row multipliers(n, 0);
  for (std::size_t r = 0; r < n; ++r) {
    for (std::size_t b = 0; b < n; ++b) multipliers[r] += inverse_[b][r] * g[pivots_[b]];
  }
  // What one rounding of each number of the rows is worth.
  Row of_rows(entries_.size(), 0);
  for (std::size_t k = 0; k < entries_.size(); ++k) {
    for (std::size_t r = 0; r < n; ++r) {
      of_rows[k] += AuditSums::kUnitRoundoff * sizes_[r][k] * std::abs(multipliers[r]);
    }
  }
  for (std::size_t k = 0; k < entries_.size(); ++k) {
    Real worst = error[k] + static_cast<Real>(1 + n) * of_rows[k];
    for (std::size_t r = 0; r < n; ++r) g[k] -= rows_[r][k] * multipliers[r];
    for (std::size_t b = 0; b < n; ++b) {
      Real follows = 0;  // entry b of what entry k moves
      for (std::size_t r = 0; r < n; ++r) follows += inverse_[b][r] * rows_[r][k];
      worst +=
          std::abs(follows) * (error[pivots_[b]] + static_cast<Real>(1 + n) * of_rows[pivots_[b]]);
    }
    (*gradient)[entries_[k]] = g[k];
    (*rounding)[entries_[k]] = worst;
  }
  for (const std::size_t k : pivots_) (*gradient)[entries_[k]] = (*rounding)[entries_[k]] = 0;
}

}  // namespace batten
