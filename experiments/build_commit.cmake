# Writes ${OUTPUT}, which says the commit of ${SOURCE}, with "-dirty" behind it where files differ
# from it or are not in it; "unknown" outside of git. Run at each build; the file stays as it is
# where it says the same already, so that nothing is built anew.
#   cmake -DGIT=git -DSOURCE=FOLDER -DTEMPLATE=FILE -DOUTPUT=FILE -P build_commit.cmake
set(BATTEN_GIT_COMMIT unknown)
if(GIT AND EXISTS ${SOURCE}/.git)
  execute_process(COMMAND ${GIT} describe --always WORKING_DIRECTORY ${SOURCE}
    OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE RESULT_VARIABLE failed ERROR_QUIET)
  execute_process(COMMAND ${GIT} status --porcelain WORKING_DIRECTORY ${SOURCE}
    OUTPUT_VARIABLE changes RESULT_VARIABLE no_status ERROR_QUIET)
  if(NOT failed)
    set(BATTEN_GIT_COMMIT ${commit})
    if(no_status OR NOT changes STREQUAL "")
      string(APPEND BATTEN_GIT_COMMIT -dirty)
    endif()
  endif()
endif()
configure_file(${TEMPLATE} ${OUTPUT} @ONLY)
