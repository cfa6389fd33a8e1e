#include "solvers/plugin.h"

BATTEN_PLUGIN(/*registry*/) {}
