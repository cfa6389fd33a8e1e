# Plugins of Batten, and programs that load them: docs/plugins.md.

# batten_add_plugin(mine mine.cc): a shared object mine.so, to be named with --plugins. It is linked
# with none of Batten's libraries: their functions are those of the program that loads it, which has
# the only registry. Its own copies of inline functions are hidden, so that it keeps to them
# whatever the program was compiled with. A plugin in C needs batten_c.h alone.
function(batten_add_plugin name)
  add_library(${name} MODULE ${ARGN})
  target_link_libraries(${name} PRIVATE Batten::plugin)
  set_target_properties(${name} PROPERTIES
    PREFIX ""
    SUFFIX .so
    CXX_EXTENSIONS OFF
    C_VISIBILITY_PRESET hidden
    CXX_VISIBILITY_PRESET hidden
    VISIBILITY_INLINES_HIDDEN ON)
endfunction()

# batten_export_symbols(program): a program that links Batten::experiments and calls LoadPlugins().
# It holds all of the libraries, also what it does not call itself, for plugins to find.
function(batten_export_symbols target)
  set(archives "")
  foreach(folder splines cost_functions problems solvers experiments)
    string(APPEND archives "$<TARGET_FILE:Batten::${folder}>,")
  endforeach()
  # In front of what is linked anyway, of which nothing is wanted then. LINK_LIBRARY:WHOLE_ARCHIVE
  # takes no library that is a dependency of another.
  target_link_options(${target} PRIVATE "LINKER:--whole-archive,${archives}--no-whole-archive")
  set_target_properties(${target} PROPERTIES ENABLE_EXPORTS ON)
endfunction()
