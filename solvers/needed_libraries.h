#ifndef BATTEN_SOLVERS_NEEDED_LIBRARIES_H_
#define BATTEN_SOLVERS_NEEDED_LIBRARIES_H_

#include <string>
#include <vector>

namespace batten {

/// The shared objects that a loaded one was linked with (its DT_NEEDED entries) and that the
/// program runs with: the paths of the files, without symbolic links, so that their names have the
/// versions, as in /usr/lib/libnlopt.so.0.11.1. In the order in which it names them; what is not
/// to be found is left out, as is what was linked into it. `library` is what dlopen() returned.
std::vector<std::string> NeededLibraries(void* library);

}  // namespace batten

#endif  // BATTEN_SOLVERS_NEEDED_LIBRARIES_H_
