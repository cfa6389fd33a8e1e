/* Option lists that no plugin may have; CASE says which. */
#include <stddef.h>

#include "solvers/batten_c.h"

static int Minimize(const batten_run* run, double* x) {
  (void)run;
  (void)x;
  return BATTEN_SOLVED;
}

#define NUMBER_OPTION(name) \
  { name, "help", 0.5, 0.0, 1.0, 0, NULL, NULL }

BATTEN_C_PLUGIN(host) {
#if CASE == 1
  const batten_option* const options = NULL;
#elif CASE == 2
  static const batten_option options[] = {NUMBER_OPTION("momentum"), NUMBER_OPTION("momentum")};
#else
  static const batten_option options[] = {NUMBER_OPTION("momentum"), NUMBER_OPTION("mom=x")};
#endif
  batten_solver solver = {0};
  solver.struct_size = sizeof(batten_solver);
  solver.name = "forged_c";
  solver.summary = "none";
  solver.source = "none";
  solver.num_options = 2;
  solver.options = options;
  solver.minimize = Minimize;
  host->add_solver(host->self, &solver);
}
