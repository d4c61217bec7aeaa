// What the allocator keeps of memory that has been given back.
#pragma once

namespace flaneur {

// From now on blocks of a quarter of a megabyte and more, as flow fields are, go back to the system at once: between
// what stays for long they left holes that grew for hours. For programs, not for libraries.
void KeepNoLargeStock();

}  // namespace flaneur
