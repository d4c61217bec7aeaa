// What Flaneur's libraries share: version, status codes, and the rules that hold for every function.
//
// Errors. Every function that can fail returns a FlaneurStatus and leaves its results as they were when it fails; the
// library's own ..._last_error() then says in one line what was wrong. No C++ exception and no signal leaves a library,
// and nothing is printed. Null pointers, numbers that are none, counts below zero and ids of things that are gone give
// a status. What cannot be seen from inside: a pointer to less than its count says, and a text without an end.
//
// Definitions (Flaneur...Def) are filled by their flaneur_default_...() function; change what you like afterwards. One
// that was not filled so is refused. What a definition points to is copied: it may go as soon as the call returns.
//
// Ids are small values to copy, compare and keep. {0, 0} is no thing. An id is never used again for another thing.
//
// Spans point into the library's own memory; each says how long it stays. Texts are UTF-8 and end in a zero byte; they
// are never null in results.
//
// Threads. There is no global state that shows. Functions may be called from any thread; calls for different things may
// run at the same time, calls for one thing may not. The text of an error belongs to the thread that met it.
//
// Versions. While FLANEUR_VERSION_MAJOR is 0, a new minor version may change structs and functions; then the shared
// library's soname changes with it. Patch versions change neither.
#ifndef FLANEUR_BASE_H
#define FLANEUR_BASE_H

#include <stdbool.h>
#include <stdint.h>

#include "flaneur/version.h"

#ifdef __cplusplus
#define FLANEUR_API extern "C" __attribute__((visibility("default")))
#else
#define FLANEUR_API __attribute__((visibility("default")))
#endif

typedef enum FlaneurStatus {
  FLANEUR_OK = 0,
  FLANEUR_ERROR_NULL = 1,          // a pointer that is needed is null
  FLANEUR_ERROR_DEFINITION = 2,    // a definition that no flaneur_default_...() has filled
  FLANEUR_ERROR_ID = 3,            // no such thing, or none any more
  FLANEUR_ERROR_OUT_OF_RANGE = 4,  // a number that is none, or beyond what its comment allows
  FLANEUR_ERROR_INPUT = 5,         // each number is fine, but they cannot be worked with; the text says why
  FLANEUR_ERROR_MEMORY = 6,        // there is not enough of it
  FLANEUR_ERROR_INTERNAL = 7       // a fault of the library; please report it with its text
} FlaneurStatus;

typedef struct FlaneurVersion {
  int major, minor, patch;
} FlaneurVersion;

// On the ground plane: metres, x east, y north.
typedef struct FlaneurPoint {
  double x, y;
} FlaneurPoint;

typedef struct FlaneurRing {
  const FlaneurPoint* points;  // the first is not repeated
  int count;
} FlaneurRing;

#endif
