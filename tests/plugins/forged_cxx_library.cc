#include "tests/plugins/forged_card.h"

BATTEN_FORGED_PLUGIN(card.cxx_library = "libstdc++, cxx11 ABI 0")
