// A file that is gone on with: nothing in it changes, and what is no whole file is refused.
#include "pipeline/io/gltf_builder.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "pipeline/io/encode_avatar.h"
#include "tests/unit/pipeline/test_person.h"

namespace flaneur {
namespace {

std::vector<uint8_t> WholePerson() {
  const AvatarLevels levels = OneLevel(MadePerson());
  EncodedAvatar encoded;
  EXPECT_EQ(EncodeAvatar(levels, {}, nullptr, &encoded).message, "");
  GltfBuilder builder;
  AvatarPart part;
  EXPECT_EQ(AddAvatar(&builder, levels, encoded, "", &part).message, "");
  builder.AddScene("person", std::vector<int>{part.skeleton_node, part.level_nodes[0]});
  std::vector<uint8_t> glb;
  EXPECT_EQ(builder.Finish(&glb).message, "");
  return glb;
}

nlohmann::json JsonOf(const std::vector<uint8_t>& glb) {
  const size_t size = glb[12] | glb[13] << 8 | glb[14] << 16;
  return nlohmann::json::parse(glb.begin() + 20, glb.begin() + 20 + static_cast<std::ptrdiff_t>(size));
}

TEST(GltfBuilder, GoesOnWithAFileAsItIs) {
  const std::vector<uint8_t> before = WholePerson();
  GltfBuilder builder;
  std::vector<uint8_t> after;
  ASSERT_EQ(builder.Resume(before).message, "");
  ASSERT_EQ(builder.Finish(&after).message, "");
  EXPECT_EQ(after, before);

  ASSERT_EQ(builder.Resume(before).message, "");
  const std::vector<uint8_t> more{1, 2, 3, 4, 5};
  const int view = builder.AddBufferView(more);
  builder.SetRootExtension("FLANEUR_more", R"({"view": 1})");
  ASSERT_EQ(builder.Finish(&after).message, "");
  nlohmann::json was = JsonOf(before), is = JsonOf(after);
  EXPECT_EQ(static_cast<size_t>(view), was["bufferViews"].size());
  const size_t offset = is["bufferViews"][static_cast<size_t>(view)]["byteOffset"];
  const std::vector<uint8_t> end(after.end() - 8, after.end() - 3);  // three bytes fill up the last word
  EXPECT_EQ(end, more);
  EXPECT_EQ(offset % 4, 0u);
  is["bufferViews"].erase(static_cast<size_t>(view));
  for (const char* key : {"meshes", "accessors", "animations", "skins", "nodes", "scenes", "bufferViews"})
    EXPECT_EQ(is[key], was[key]) << key;
  EXPECT_EQ(is["extensionsRequired"], was["extensionsRequired"]);
}

TEST(GltfBuilder, RefusesToGoOnWithWhatIsNoWholeFile) {
  const std::vector<uint8_t> whole = WholePerson();
  for (const size_t size : {size_t{0}, size_t{11}, size_t{19}, size_t{40}, whole.size() / 2, whole.size() - 1}) {
    GltfBuilder builder;
    EXPECT_NE(builder.Resume({whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)}).message, "") << size;
  }
  std::vector<uint8_t> longer = whole;
  longer[13] = 0xFF;  // a description beyond the file's end
  longer[15] = 0x7F;
  EXPECT_NE(GltfBuilder().Resume(longer).message, "");
}

}  // namespace
}  // namespace flaneur
