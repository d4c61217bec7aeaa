// A tour pack for the line: the same tour with fewer texels. Internal to pipeline/web.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "runtime/base/error.h"

namespace flaneur {

struct Lighter {
  int atlas_levels_left_out = 1;   // the finest of impostor atlases, as far as others are left
  int normal_levels_left_out = 2;  // and of their pictures of normals
  int picture_quality = 60;        // of JPEG, 1 to 100; what is smaller as it is stays; 0: all stay
};

// A valid pack again, without the title page, which the site has beside it. `pack`: has been read as one.
Error MakeLighter(const Lighter& lighter, std::vector<uint8_t>* pack);

}  // namespace flaneur
