# run(COMMAND...): runs a command and stops the script with its output if it fails. Sets `output`.
function(run)
  execute_process(COMMAND ${ARGV} RESULT_VARIABLE result OUTPUT_VARIABLE out ERROR_VARIABLE error)
  if(NOT result EQUAL 0)
    list(JOIN ARGV " " command)
    message(FATAL_ERROR "${command}\nfailed (${result}):\n${out}${error}")
  endif()
  set(output "${out}" PARENT_SCOPE)
endfunction()

# expect(TEXT...): stops the script unless `output` contains each text.
function(expect)
  foreach(text ${ARGV})
    string(FIND "${output}" "${text}" at)
    if(at EQUAL -1)
      message(FATAL_ERROR "\"${text}\" is missing in the output:\n${output}")
    endif()
  endforeach()
endfunction()
