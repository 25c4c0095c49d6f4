# Checks the Markdown files of the repository:
# - Every relative link names a file or folder.
# - Every name in backquotes that looks like a path into the repository exists.
# - The programs in them are the programs of tests/package/consumer.
# - Public headers name public headers only.
# With -D installed=ON it checks only the links in the documents of an installed tree.
cmake_minimum_required(VERSION 3.25)
set(wrong)

# Ends the check with an error if there are findings.
function(report)
  if(wrong)
    list(JOIN wrong "\n  " lines)
    message(FATAL_ERROR "The documents are wrong:\n  ${lines}")
  endif()
endfunction()

file(GLOB documents RELATIVE ${root} ${root}/*.md)
file(GLOB_RECURSE more RELATIVE ${root} ${root}/docs/*.md ${root}/meshes/*.md ${root}/scenes/*.md ${root}/bench/*.md)
list(APPEND documents ${more})

foreach(document IN LISTS documents)
  file(READ ${root}/${document} text)
  # CMake splits lists at semicolons, except between brackets. The items must contain neither.
  string(REPLACE ";" "," text "${text}")
  string(REPLACE "](" "@link(" text "${text}")
  string(REPLACE "[" "<" text "${text}")
  string(REPLACE "]" ">" text "${text}")
  cmake_path(GET document PARENT_PATH folder)
  string(REGEX MATCHALL "@link\\([^)#: ]+[)#]" links "${text}")
  foreach(link IN LISTS links)
    string(REGEX REPLACE "^@link\\((.*)[)#]$" "\\1" target "${link}")
    if(NOT EXISTS ${root}/${folder}/${target})
      list(APPEND wrong "${document}: the link ${target} leads nowhere")
    endif()
  endforeach()
  if(installed)
    continue()
  endif()
  string(REGEX MATCHALL "`(src|tests|scripts|scenes|docs|cmake)/[A-Za-z0-9_./-]+`" names "${text}")
  foreach(name IN LISTS names)
    string(REPLACE "`" "" name "${name}")
    if(NOT EXISTS ${root}/${name})
      list(APPEND wrong "${document}: there is no ${name}")
    endif()
  endforeach()
endforeach()

if(installed)
  report()
  return()
endif()

foreach(pair IN ITEMS README.md=main.cpp docs/library.md=walkthrough.cpp)
  string(REPLACE "=" ";" pair ${pair})
  list(GET pair 0 document)
  list(GET pair 1 program)
  file(READ ${root}/${document} text)
  file(READ ${root}/tests/package/consumer/${program} example)
  string(FIND "${text}" "```cpp\n${example}```" position)
  if(position EQUAL -1)
    list(APPEND wrong "${document}: the program in it is not tests/package/consumer/${program}")
  endif()
endforeach()

# Users of the installed library have its public headers and no others.
file(STRINGS ${root}/src/ricochet/public_headers.txt public_headers REGEX "^[^#]")
foreach(header IN LISTS public_headers)
  file(READ ${root}/src/ricochet/${header} text)
  string(REPLACE ";" "," text "${text}")
  string(REGEX MATCHALL "[A-Za-z0-9_/]+[.]h[^A-Za-z0-9_]" names "${text}")
  foreach(name IN LISTS names)
    string(REGEX REPLACE "^(ricochet/)?(.*[.]h).$" "\\2" name "${name}")
    if(NOT name IN_LIST public_headers)
      list(APPEND wrong "src/ricochet/${header}: ${name} is not installed")
    endif()
  endforeach()
endforeach()

report()
