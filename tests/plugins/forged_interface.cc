#include "tests/plugins/forged_card.h"

BATTEN_FORGED_PLUGIN(card.interface = "Rust")
