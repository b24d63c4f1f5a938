/* The version of orchard, for the preprocessor and for C. The build reads its version only here. Until 1.0.0, any
 * minor version may change an interface. */
#ifndef ORCHARD_RUNTIME_VERSION_H
#define ORCHARD_RUNTIME_VERSION_H

#define ORCHARD_VERSION_MAJOR 0
#define ORCHARD_VERSION_MINOR 3
#define ORCHARD_VERSION_PATCH 0
#define ORCHARD_VERSION_STRING "0.3.0"

/* A version as one number, for comparisons such as ORCHARD_VERSION_NUMBER >= ORCHARD_MAKE_VERSION(0, 2, 0). */
#define ORCHARD_MAKE_VERSION(major, minor, patch) ((major)*1000000 + (minor)*1000 + (patch))
#define ORCHARD_VERSION_NUMBER ORCHARD_MAKE_VERSION(ORCHARD_VERSION_MAJOR, ORCHARD_VERSION_MINOR, ORCHARD_VERSION_PATCH)

#endif
