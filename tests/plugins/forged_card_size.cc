#include "tests/plugins/forged_card.h"

BATTEN_FORGED_PLUGIN(card.struct_size += 8)
