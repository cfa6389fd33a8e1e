#include <stdexcept>

#include "solvers/plugin.h"

BATTEN_PLUGIN(/*registry*/) { throw std::runtime_error("no licence found"); }
