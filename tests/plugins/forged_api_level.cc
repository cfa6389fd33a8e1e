#include "tests/plugins/forged_card.h"

BATTEN_FORGED_PLUGIN(card.api_level = BATTEN_API_LEVEL + 1)
