/* What a plugin has in common with the program that loads it, as plain C: the ABI card, and an
 * interface through which a solver can be written in C, Fortran or Rust. It needs no other header
 * of Batten and links nothing. docs/plugins.md explains it, examples/plugin_c_solver uses it. */
#ifndef BATTEN_C_H_
#define BATTEN_C_H_

#include <stdint.h> /* NOLINT(modernize-deprecated-headers): this is C */

#ifdef __cplusplus
extern "C" {
#endif

/* Raised whenever an interface that plugins see changes. */
#define BATTEN_API_LEVEL 7

/* What must be the same on both sides. Of a plugin in C the fields after `interface` are 0. */
typedef struct batten_card {
  uint32_t struct_size;      /* sizeof(batten_card) */
  uint32_t api_level;        /* BATTEN_API_LEVEL */
  const char* interface;     /* "C++" or "C" */
  const char* compiler;      /* family and major version: "GCC 12" */
  const char* cxx_library;   /* "libstdc++, cxx11 ABI 1" */
  const char* eigen_version; /* "3.4.0" */
  uint32_t eigen_alignment;  /* EIGEN_MAX_ALIGN_BYTES, which -march=native changes */
  uint32_t eigen_packet;     /* EIGEN_DEFAULT_ALIGN_BYTES, which also says whose memory is freed */
  uint32_t eigen_row_major;  /* 1: matrices are row-major by default */
  const char* ceres_version; /* "2.1.0" */
  uint64_t class_layout;     /* a number made of the sizes of the classes that cross over */
} batten_card;

/* How a run goes on: what the callbacks below return. */
enum {
  BATTEN_OK = 0,
  BATTEN_STOP = 1,      /* return now, whatever the reason: the program knows it */
  BATTEN_NON_FINITE = 2 /* no number there; a line search may back up */
};

/* Why a solver returned, where the program did not tell it to. */
enum {
  BATTEN_SOLVED = 0,            /* a direct method has given its answer */
  BATTEN_LINE_SEARCH_ENDED = 1, /* no step along the last direction lowers E measurably */
  BATTEN_NATIVE_STOP = 2,       /* a rule of the method's own */
  BATTEN_STALLED = 3,
  BATTEN_NUMERICAL_FAILURE = 4 /* also the one to give after BATTEN_STOP: it is not looked at */
};

/* One run, as a solver sees it. Arrays have `size` doubles; `self` is handed back to each call.
 * Every energy and gradient is counted; no other call is. */
typedef struct batten_run {
  void* self;
  int64_t size; /* number of free variables */
  uint64_t seed;
  int32_t threads; /* most that may be used */
  int32_t is_quadratic;
  int (*energy)(void* self, const double* x, double* energy);
  int (*energy_and_gradient)(void* self, const double* x, double* energy, double* gradient);
  /* The same without E, which costs less where E is quadratic. */
  int (*gradient)(void* self, const double* x, double* gradient);
  /* Second derivative of E at x times v: exact. */
  int (*hessian_times)(void* self, const double* x, const double* v, double* product);
  /* Sums in a fixed order, so that the same run gives the same bits. */
  double (*dot)(void* self, const double* a, const double* b);
  double (*norm)(void* self, const double* a);
  /* Books x: once at the start, then after each iteration. BATTEN_STOP: return at once, with x as
   * it is. */
  int (*iterate)(void* self, const double* x);
  /* Something that belongs beside the result. */
  void (*note)(void* self, const char* name, const char* value);
  /* The value of an option that the solver has announced. */
  double (*number)(void* self, const char* option);
  const char* (*word)(void* self, const char* option);
} batten_run;

/* One option: a number from lowest to highest, or (words not NULL) one of "a,b,c". */
typedef struct batten_option {
  const char* name;
  const char* help; /* one line */
  double default_number;
  double lowest;
  double highest;
  int32_t is_integer;
  const char* words;
  const char* default_word;
} batten_option;

typedef struct batten_solver {
  uint32_t struct_size; /* sizeof(batten_solver) */
  uint32_t num_options;
  const char* name;
  const char* summary; /* one line */
  const char* source;  /* where the method is from */
  const batten_option* options;
  /* Lowers E from x, which holds the start, and leaves the last booked point there. Returns one of
   * the reasons above. */
  int (*minimize)(const batten_run* run, double* x);
} batten_solver;

/* What a plugin in C registers with. */
typedef struct batten_host {
  void* self;
  void (*add_solver)(void* self, const batten_solver* solver); /* copied */
} batten_host;

#if defined(__GNUC__)
#define BATTEN_EXPORT __attribute__((visibility("default")))
#else
#define BATTEN_EXPORT
#endif

/* The two symbols of a plugin in C:
 *   BATTEN_C_PLUGIN(host) { host->add_solver(host->self, &my_solver); } */
BATTEN_EXPORT const batten_card* batten_plugin_card(void);
BATTEN_EXPORT void batten_plugin_register_c(const batten_host* host);
/* NOLINTBEGIN(bugprone-macro-parentheses): the name of a parameter */
#define BATTEN_C_PLUGIN(host)                                                          \
  const batten_card* batten_plugin_card(void) {                                        \
    static const batten_card card = {                                                  \
        (uint32_t)sizeof(batten_card), BATTEN_API_LEVEL, "C", 0, 0, 0, 0, 0, 0, 0, 0}; \
    return &card;                                                                      \
  }                                                                                    \
  void batten_plugin_register_c(const batten_host* host)
/* NOLINTEND(bugprone-macro-parentheses) */

#ifdef __cplusplus
}
#endif

#endif /* BATTEN_C_H_ */
