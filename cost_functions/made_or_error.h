#ifndef BATTEN_COST_FUNCTIONS_MADE_OR_ERROR_H_
#define BATTEN_COST_FUNCTIONS_MADE_OR_ERROR_H_

#include <exception>
#include <new>
#include <string>

#include "cost_functions/options.h"

namespace batten {

/// make(), a pointer; what it throws, but for want of memory, makes it null with one sentence in
/// `error` that begins with `what`: "solver cg".
template <typename Make>
auto MadeOrError(const std::string& what, const Make& make, std::string* error)
    -> decltype(make()) {
  try {
    return make();
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& exception) {
    constexpr std::size_t kLongest = 300;
    *error = what + " threw an exception while it was made: " + Quoted(exception.what(), kLongest);
    return nullptr;
  }
}

}  // namespace batten

#endif  // BATTEN_COST_FUNCTIONS_MADE_OR_ERROR_H_
