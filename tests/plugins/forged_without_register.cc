#include "solvers/plugin_card.h"

extern "C" BATTEN_EXPORT const batten_card* batten_plugin_card() { return &batten::kThisCard; }
