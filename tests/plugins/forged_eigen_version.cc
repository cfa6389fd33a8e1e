#include "tests/plugins/forged_card.h"

BATTEN_FORGED_PLUGIN(card.eigen_version = "3.3.9")
