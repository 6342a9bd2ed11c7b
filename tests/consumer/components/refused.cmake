# What find_package says of components that are not there, one sentence each.
#   cmake -D PREFIX=... -D SCRATCH=... -D "OPTIONS=..." -P refused.cmake

function(expect prefix components sentence)
  execute_process(
    COMMAND ${CMAKE_COMMAND} --fresh -S ${CMAKE_CURRENT_LIST_DIR} -B ${SCRATCH}/build -DCMAKE_PREFIX_PATH=${prefix}
      -DCMAKE_FIND_USE_PACKAGE_REGISTRY=OFF ${OPTIONS} "-DCONSUMER_COMPONENTS=${components}"
    RESULT_VARIABLE result OUTPUT_QUIET ERROR_VARIABLE said)
  string(REGEX REPLACE "[ \n]+" " " said "${said}")  # CMake breaks its lines
  string(FIND "${said}" "Reason given by package: ${sentence} " at)
  if(result EQUAL 0 OR at EQUAL -1)
    message(SEND_ERROR "find_package with ${components}: expected \"${sentence}\", found (exit ${result}):\n${said}")
  endif()
endfunction()

expect(${PREFIX} "COMPONENTS;march;nonsense"
  "rollfix: found the component \"nonsense\", expected march, files, catalog, draw or c; rollfix::rollfix needs none.")

# The same prefix, as it is when the others are not built.
file(REMOVE_RECURSE ${SCRATCH}/bare)
file(COPY ${PREFIX}/ DESTINATION ${SCRATCH}/bare)
file(GLOB_RECURSE unbuilt ${SCRATCH}/bare/*/rollfix_files* ${SCRATCH}/bare/*/rollfix_catalog*
  ${SCRATCH}/bare/*/rollfix_draw* ${SCRATCH}/bare/*/rollfix_cT* ${SCRATCH}/bare/*/librollfix_[cfd]*)
file(REMOVE ${unbuilt})
foreach(component IN ITEMS files catalog draw c)
  string(TOUPPER ${component} option)
  expect(${SCRATCH}/bare "COMPONENTS;${component}"
    "rollfix: the component \"${component}\" was not built: build rollfix with -DROLLFIX_BUILD_${option}=ON.")
endforeach()
