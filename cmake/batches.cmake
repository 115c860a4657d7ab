# arris_compile_in_batches(TARGET): its sources are compiled in the groups that scripts/batches.py finds, a
# unity build where a group never holds two files that would collide. The groups are made anew at each
# configuration; a build that complains about names defined twice after an edit wants one. What the fuzzers
# look at stays apart: see fuzzed.txt.
find_package(Python3 REQUIRED COMPONENTS Interpreter)

function(arris_compile_in_batches target)
  get_target_property(all ${target} SOURCES)
  list(FILTER all INCLUDE REGEX "\\.cpp$")
  list(FILTER all EXCLUDE REGEX "^${PROJECT_BINARY_DIR}/")
  set(fuzzed ${all})
  list(FILTER fuzzed INCLUDE REGEX "/src/io/|/view/(access|view_protocol)")
  set(other ${all})
  list(FILTER other EXCLUDE REGEX "/src/io/|/view/(access|view_protocol)")
  foreach(part IN ITEMS fuzzed other)
    if(NOT ${part})
      continue()
    endif()
    execute_process(COMMAND ${Python3_EXECUTABLE} ${PROJECT_SOURCE_DIR}/scripts/batches.py ${${part}}
      OUTPUT_VARIABLE lines OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
    string(REPLACE "\n" ";" lines "${lines}")
    foreach(line IN LISTS lines)
      string(REGEX MATCH "^([0-9]+) (.*)$" matched "${line}")
      set_source_files_properties(${CMAKE_MATCH_2} PROPERTIES UNITY_GROUP ${part}${CMAKE_MATCH_1})
    endforeach()
  endforeach()
  # Highway includes such a file again for each kind of processor.
  foreach(source IN LISTS all)
    file(STRINGS ${source} again REGEX "hwy/foreach_target" LIMIT_COUNT 1)
    if(again)
      set_source_files_properties(${source} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
    endif()
  endforeach()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
  # GCC takes a class of a source for one of a header, as the source is included.
  target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)
endfunction()
