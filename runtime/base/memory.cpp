#include "runtime/base/memory.h"

#include <cstdlib>  // says whether there is glibc

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace flaneur {

void KeepNoLargeStock() {
#ifdef __GLIBC__
  mallopt(M_MMAP_THRESHOLD, 256 * 1024);
#endif
}

}  // namespace flaneur
