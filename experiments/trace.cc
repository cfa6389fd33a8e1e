#include "experiments/trace.h"

#include "experiments/csv_table.h"

namespace batten {
namespace {

/// Quoted where a comma, a quote or a line break would end the field (RFC 4180).
std::string Quoted(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

}  // namespace

std::string TraceCsv(const std::vector<TraceRow>& trace, const std::vector<std::string>& term_names,
                     bool is_constrained) {
  std::string text =
      "iteration,energy_calls,gradient_calls,jacobian_calls,products,projections,seconds,"
      "cpu_seconds,energy,gradient_norm,step_norm";
  if (is_constrained) text += ",constraint_violation";
  for (const std::string& name : term_names) text += "," + Quoted("energy_" + name);
  text += '\n';
  for (const TraceRow& row : trace) {
    text += std::to_string(row.iteration);
    const Counts& counts = row.counts;
    for (const long count : {counts.energy_calls, counts.gradient_calls, counts.jacobian_calls,
                             counts.products, counts.projections}) {
      text += ',' + std::to_string(count);
    }
    for (const double value :
         {row.seconds, row.cpu_seconds, row.energy, row.gradient_norm, row.step_norm}) {
      text += ',' + NumberCell(value);
    }
    if (is_constrained) text += ',' + NumberCell(row.violation);
    for (std::size_t k = 0; k < term_names.size(); ++k) {
      const bool only_one = row.term_energies.empty() && term_names.size() == 1;
      text += ',';
      if (only_one) text += NumberCell(row.energy);
      if (k < row.term_energies.size()) text += NumberCell(row.term_energies[k]);
    }
    text += '\n';
  }
  return text;
}

}  // namespace batten
