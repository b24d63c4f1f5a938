# ORCHARD_VERSION: what version.h says.
set(orchard_version_header ${CMAKE_CURRENT_LIST_DIR}/../include/orchard/runtime/version.h)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${orchard_version_header})
file(STRINGS ${orchard_version_header} orchard_version_lines REGEX "define ORCHARD_VERSION_(MAJOR|MINOR|PATCH) +[0-9]+$")
list(TRANSFORM orchard_version_lines REPLACE "^.* ([0-9]+)$" "\\1")
list(JOIN orchard_version_lines "." ORCHARD_VERSION)
