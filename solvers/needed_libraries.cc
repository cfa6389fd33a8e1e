#include "solvers/needed_libraries.h"

#include <dlfcn.h>
#include <link.h>

#include <filesystem>

namespace batten {
namespace {

/// Names as they stand in the object: "libnlopt.so.0".
std::vector<std::string> NeededNames(const link_map& object) {
  const char* strings = nullptr;
  for (const ElfW(Dyn)* entry = object.l_ld; entry->d_tag != DT_NULL; ++entry) {
    if (entry->d_tag != DT_STRTAB) continue;
    // An address, which the loader has moved to where the object is; not on every processor.
    ElfW(Addr) address = entry->d_un.d_ptr;
    if (address < object.l_addr) address += object.l_addr;
    strings = reinterpret_cast<const char*>(object.l_ld) +
              (address - reinterpret_cast<ElfW(Addr)>(object.l_ld));
  }
  std::vector<std::string> names;
  if (strings == nullptr) return names;
  for (const ElfW(Dyn)* entry = object.l_ld; entry->d_tag != DT_NULL; ++entry) {
    if (entry->d_tag == DT_NEEDED) names.emplace_back(strings + entry->d_un.d_val);
  }
  return names;
}

}  // namespace

std::vector<std::string> NeededLibraries(void* library) {
  std::vector<std::string> paths;
  link_map* object = nullptr;
  if (dlinfo(library, RTLD_DI_LINKMAP, &object) != 0) return paths;
  for (const std::string& name : NeededNames(*object)) {
    // It is loaded already: this only finds it, by the name that it was asked for.
    void* const needed = dlopen(name.c_str(), RTLD_LAZY | RTLD_NOLOAD);
    link_map* found = nullptr;
    if (needed == nullptr) continue;
    if (dlinfo(needed, RTLD_DI_LINKMAP, &found) == 0) {
      std::error_code code;
      const std::filesystem::path path = std::filesystem::canonical(found->l_name, code);
      if (!code) paths.push_back(path.string());
    }
    dlclose(needed);
  }
  return paths;
}

}  // namespace batten
