// Whole numbers of glTF extensions. Internal to pipeline/io.
#pragma once

namespace tinygltf {
class Value;
}

namespace flaneur {

// -1 where it is no number that an int can be, and so no index of anything; fractions are cut.
int IndexOf(const tinygltf::Value& value);

}  // namespace flaneur
