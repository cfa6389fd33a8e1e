/* Nonlinear conjugate gradients after Polak and Ribiere, with steps that are halved until E falls
 * by enough: a solver in plain C. A run ends when the program says so. */
#include <stdlib.h>
#include <string.h>

#include "solvers/batten_c.h"

/* to = from + factor * along */
static void combine(int64_t size, const double* from, double factor, const double* along,
                    double* to) {
  for (int64_t i = 0; i < size; ++i) to[i] = from[i] + factor * along[i];
}

static int iterate(const batten_run* run, double* x, double* gradient, double* direction,
                   double* trial, double* next) {
  void* const self = run->self;
  const double decrease = run->number(self, "decrease");
  double energy, step = 1.0;
  if (run->energy_and_gradient(self, x, &energy, gradient) != BATTEN_OK ||
      run->iterate(self, x) != BATTEN_OK) {
    return BATTEN_NUMERICAL_FAILURE; /* or a stop, which the program knows of */
  }
  memset(direction, 0, (size_t)run->size * sizeof(double));
  for (double beta = 0.0;;) {
    for (int64_t i = 0; i < run->size; ++i) direction[i] = beta * direction[i] - gradient[i];
    double slope = run->dot(self, gradient, direction);
    const double square = run->dot(self, gradient, gradient);
    if (square == 0.0) return BATTEN_SOLVED;
    if (!(slope < 0.0)) { /* no descent: begin anew along the gradient */
      for (int64_t i = 0; i < run->size; ++i) direction[i] = -gradient[i];
      slope = -square;
    }
    double energy_there;
    for (;; step *= 0.5) {
      if (step < 1e-20) return BATTEN_LINE_SEARCH_ENDED;
      combine(run->size, x, step, direction, trial);
      const int status = run->energy_and_gradient(self, trial, &energy_there, next);
      if (status == BATTEN_STOP) return BATTEN_NUMERICAL_FAILURE;
      if (status == BATTEN_OK && energy_there < energy + decrease * step * slope) break;
    }
    memcpy(x, trial, (size_t)run->size * sizeof(double));
    if (run->iterate(self, x) != BATTEN_OK) return BATTEN_NUMERICAL_FAILURE;
    beta = (run->dot(self, next, next) - run->dot(self, next, gradient)) / square;
    if (!(beta > 0.0)) beta = 0.0;
    memcpy(gradient, next, (size_t)run->size * sizeof(double));
    energy = energy_there;
    step *= 2.0;
  }
}

static int minimize(const batten_run* run, double* x) {
  const size_t size = (size_t)run->size;
  double* const work = malloc(4 * size * sizeof(double));
  if (work == NULL) return BATTEN_NUMERICAL_FAILURE;
  const int reason = iterate(run, x, work, work + size, work + 2 * size, work + 3 * size);
  free(work);
  return reason;
}

static const batten_option options[] = {
    {"decrease", "part of the slope that a step must lower E by", 1e-4, 1e-8, 0.5, 0, NULL, NULL}};

static const batten_solver solver = {sizeof(batten_solver),
                                     sizeof(options) / sizeof(options[0]),
                                     "polak_ribiere",
                                     "nonlinear conjugate gradients, written in C",
                                     "Polak & Ribiere, Rev. Fr. Inform. Rech. Oper. 3-R1, 1969",
                                     options,
                                     &minimize};

BATTEN_C_PLUGIN(host) { host->add_solver(host->self, &solver); }
