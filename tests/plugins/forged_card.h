// A plugin whose card `change` has made another one.
#ifndef BATTEN_TESTS_PLUGINS_FORGED_CARD_H_
#define BATTEN_TESTS_PLUGINS_FORGED_CARD_H_

#include "solvers/plugin_card.h"

#define BATTEN_FORGED_PLUGIN(change)                                 \
  extern "C" BATTEN_EXPORT const batten_card* batten_plugin_card() { \
    static batten_card card = batten::kThisCard;                     \
    change;                                                          \
    return &card;                                                    \
  }                                                                  \
  extern "C" BATTEN_EXPORT void batten_plugin_register(batten::PluginRegistry*) {}

#endif  // BATTEN_TESTS_PLUGINS_FORGED_CARD_H_
