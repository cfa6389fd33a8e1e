#include "tests/plugins/forged_card.h"

BATTEN_FORGED_PLUGIN(card.ceres_version = "1.14.0")
