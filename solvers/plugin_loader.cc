#include "solvers/plugin_loader.h"

#include <cxxabi.h>
#include <dlfcn.h>
#include <elf.h>
#include <link.h>
#include <sys/types.h>
// After sys/types.h, whose types it uses.
#include <sha256.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <filesystem>
#include <fstream>
#include <memory>
#include <system_error>

#include "problems/input_file.h"
#include "solvers/c_solver.h"
#include "solvers/needed_libraries.h"

namespace batten {
namespace {

namespace fs = std::filesystem;

constexpr char kAllowed[] = "a plugin built with batten_add_plugin (docs/plugins.md)";

/// Empty: `path` begins as a shared object of this machine does, and holds all that its program
/// headers say. The loader does not look: it maps what is missing, and the first touch is fatal.
std::string WhyNoSharedObject(const std::string& path) {
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  const auto size = static_cast<std::uint64_t>(file.tellg());
  ElfW(Ehdr) header = {};
  file.seekg(0);
  file.read(reinterpret_cast<char*>(&header), sizeof(header));
  const bool is_elf = file.good() && std::memcmp(header.e_ident, ELFMAG, SELFMAG) == 0;
  if (!is_elf || header.e_type != ET_DYN || header.e_phentsize != sizeof(ElfW(Phdr))) {
    return "is no shared object; allowed: " + std::string(kAllowed);
  }
  for (int i = 0; i < header.e_phnum; ++i) {
    ElfW(Phdr) part = {};
    file.seekg(static_cast<std::streamoff>(header.e_phoff + i * sizeof(part)));
    file.read(reinterpret_cast<char*>(&part), sizeof(part));
    if (!file.good() || part.p_offset > size || part.p_filesz > size - part.p_offset) {
      return "is cut off: a shared object of which the end is missing";
    }
  }
  return "";
}

std::string Demangled(const std::string& symbol) {
  int status = 0;
  const std::unique_ptr<char, void (*)(void*)> text(
      abi::__cxa_demangle(symbol.c_str(), nullptr, nullptr, &status), &std::free);
  return text == nullptr ? symbol : text.get();
}

/// What dlopen() says, without the path in front; symbols as they are written in C++.
std::string WhyNotOpened(const std::string& path) {
  const char* const said = dlerror();
  std::string text = said == nullptr ? "unknown reason" : said;
  if (text.compare(0, path.size() + 2, path + ": ") == 0) text.erase(0, path.size() + 2);
  const std::string undefined = "undefined symbol: ";
  if (text.compare(0, undefined.size(), undefined) != 0) return "cannot be loaded: " + text;
  const std::string symbol = text.substr(undefined.size(), text.find('\t') - undefined.size());
  return "cannot be loaded: it needs the symbol " + Demangled(symbol) +
         ", which this program does not have; build it against this Batten";
}

template <typename Function>
Function* Symbol(void* library, const char* name) {
  return reinterpret_cast<Function*>(dlsym(library, name));
}

std::string NoSymbol(const char* name) {
  return std::string("has no symbol ") + name + "; allowed: " + kAllowed;
}

/// What `registers` throws, as a sentence.
template <typename Registers>
std::string WhatIsThrown(Registers registers) {
  try {
    registers();
  } catch (const std::exception& exception) {
    return std::string("threw while it registered: ") + exception.what();
  } catch (...) {
    return "threw while it registered";
  }
  return "";
}

std::string Register(void* library, const std::string& path, bool is_c,
                     std::vector<PluginName>* names) {
  PluginRegistry registry;
  std::string why;
  if (is_c) {
    auto* const add = Symbol<void(const batten_host*)>(library, "batten_plugin_register_c");
    if (add == nullptr) return NoSymbol("batten_plugin_register_c");
    why = RegisterCSolvers(add, &registry);
  } else {
    auto* const add = Symbol<void(PluginRegistry*)>(library, "batten_plugin_register");
    if (add == nullptr) return NoSymbol("batten_plugin_register");
    why = WhatIsThrown([&] { add(&registry); });
  }
  return why.empty() ? registry.Commit(path, names) : why;
}

/// A library that was opened stays open, whatever comes of it: it may have left something behind
/// that points into it.
std::string LoadOne(LoadedPlugin* plugin) {
  const std::string& path = plugin->path;
  std::string broken = WhyNoSharedObject(path);
  if (!broken.empty()) return broken;
  plugin->sha256 = Sha256OfFile(path);
  if (plugin->sha256.empty()) return "cannot be read";
  // NOW: what is missing is to be said here, not in the middle of a run.
  void* const library = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) return WhyNotOpened(path);
  auto* const get_card = Symbol<const batten_card*()>(library, "batten_plugin_card");
  if (get_card == nullptr) return NoSymbol("batten_plugin_card");
  const batten_card* const card = get_card();
  if (card == nullptr) return "has no card; allowed: " + std::string(kAllowed);
  std::string why = WhyRefused(*card);
  if (!why.empty()) return why;
  plugin->card = FieldsOf(*card);
  plugin->libraries = NeededLibraries(library);
  const bool is_c = std::strcmp(card->interface, "C") == 0;
  return Register(library, path, is_c, &plugin->names);
}

}  // namespace

std::string Sha256OfFile(const std::string& path) {
  char digits[SHA256_DIGEST_STRING_LENGTH];
  return SHA256File(path.c_str(), digits) == nullptr ? "" : digits;
}

std::string LoadPlugins(const std::vector<std::string>& paths, std::vector<LoadedPlugin>* loaded) {
  for (const std::string& path : paths) {
    std::ifstream file;
    std::string error;
    if (!OpenInput(path, &file, &error)) return error;
    LoadedPlugin plugin;
    std::error_code code;
    plugin.path = fs::canonical(path, code).string();
    if (code) return path + ": cannot be read: " + code.message();
    const bool is_there =
        std::any_of(loaded->begin(), loaded->end(),
                    [&plugin](const LoadedPlugin& other) { return other.path == plugin.path; });
    if (is_there) continue;
    const std::string why = LoadOne(&plugin);
    if (!why.empty()) return path + ": " + why;
    loaded->push_back(std::move(plugin));
  }
  return "";
}

bool PluginsOfPath(const std::string& text, std::vector<std::string>* paths, std::string* error) {
  paths->clear();
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(':', begin), text.size());
    const std::string part = text.substr(begin, end - begin);
    begin = end + 1;
    if (part.empty()) continue;
    std::error_code code;
    if (!fs::is_directory(part, code)) {
      paths->push_back(part);
      continue;
    }
    std::vector<std::string> files;
    fs::directory_iterator file(part, code);
    for (; !code && file != fs::directory_iterator(); file.increment(code)) {
      if (file->path().extension() == ".so") files.push_back(file->path().string());
    }
    if (code) {
      *error = part + ": cannot be read: " + code.message();
      return false;
    }
    std::sort(files.begin(), files.end());
    paths->insert(paths->end(), files.begin(), files.end());
  }
  return true;
}

std::vector<LoadedPlugin>& LoadedPlugins() {
  static auto& plugins = *new std::vector<LoadedPlugin>;
  return plugins;
}

}  // namespace batten
