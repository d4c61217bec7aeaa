#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <unistd.h>

#include <algorithm>

#include <filesystem>
#include <fstream>
#include <random>

#include "runtime/base/draco_size.h"
#include "runtime/base/file.h"
#include "runtime/base/limits.h"
#include "runtime/base/math.h"
#include "runtime/base/text.h"

namespace flaneur {
namespace {

namespace fs = std::filesystem;

class TemporaryFolder {
 public:
  TemporaryFolder() : path_(fs::temp_directory_path() / ("flaneur_base_" + std::to_string(::getpid()))) {
    fs::create_directories(path_);
  }
  ~TemporaryFolder() { fs::remove_all(path_); }
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

size_t FilesIn(const fs::path& folder) {
  return static_cast<size_t>(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

TEST(File, ComesBackAsWritten) {
  TemporaryFolder folder;
  const fs::path path = folder.path() / "deeper" / "a.bin";
  const std::vector<uint8_t> bytes{0, 1, 255, 10, 13};
  ASSERT_EQ(WriteFile(path, bytes).message, "");
  std::vector<uint8_t> back;
  ASSERT_EQ(ReadFile(path, &back).message, "");
  EXPECT_EQ(back, bytes);
  EXPECT_EQ(FilesIn(path.parent_path()), 1u);
}

// The shared memory beside the devices is a folder like any other: what stands there is replaced, not added to.
TEST(File, AFileBesideTheDevicesIsReplaced) {
  const fs::path memory = "/dev/shm/flaneur_base_" + std::to_string(::getpid());
  std::error_code ec;
  fs::create_directories(memory, ec);
  if (ec) GTEST_SKIP() << "no /dev/shm here";
  const fs::path path = memory / "a.bin", link = memory / "b.bin";
  fs::create_symlink(path, link);
  for (const fs::path& name : {path, path, link}) EXPECT_EQ(WriteTextFile(name, "once").message, "");
  std::string text;
  EXPECT_EQ(ReadTextFile(path, &text).message, "");
  EXPECT_EQ(text, "once");
  EXPECT_TRUE(fs::is_symlink(link));
  fs::remove_all(memory);
}

// As with `-o /dev/stdout > a.txt`: what the shell and others wrote there stays.
TEST(File, AnOpenFileIsAddedTo) {
  TemporaryFolder folder;
  const fs::path path = folder.path() / "a.txt", link = folder.path() / "b.txt";
  const int fd = ::open(path.c_str(), O_WRONLY | O_CREAT, 0644);
  ASSERT_GE(fd, 0);
  ASSERT_EQ(::write(fd, "before ", 7), 7);
  fs::create_symlink("/dev/fd/" + std::to_string(fd), link);
  for (const std::string& name :
       {"/proc/self/fd/" + std::to_string(fd), "/dev/fd/" + std::to_string(fd), link.string()})
    EXPECT_EQ(WriteTextFile(name, "and ").message, "") << name;
  ASSERT_EQ(::write(fd, "after", 5), 5);
  ::close(fd);
  std::string text;
  EXPECT_EQ(ReadTextFile(path, &text).message, "");
  EXPECT_EQ(text, "before and and and after");
}

TEST(File, ComesBackIntoRoomThatNobodyHasWritten) {
  TemporaryFolder folder;
  const fs::path path = folder.path() / "a.bin";
  std::vector<uint8_t> bytes(50'000);
  for (size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<uint8_t>(i * 7 / 3);
  ASSERT_EQ(WriteFile(path, bytes).message, "");
  FileBytes back;
  ASSERT_EQ(ReadFile(path, &back).message, "");
  EXPECT_TRUE(std::ranges::equal(back.span(), bytes));
  ASSERT_EQ(WriteFile(path, std::span<const uint8_t>{}).message, "");
  ASSERT_EQ(ReadFile(path, &back).message, "");
  EXPECT_TRUE(back.empty());
  EXPECT_FALSE(ReadFile(folder.path(), &back).message.empty());
  EXPECT_TRUE(std::ranges::equal(FileBytes(bytes).span(), bytes));
}

TEST(File, AFailedWriteKeepsWhatWasThere) {
  TemporaryFolder folder;
  const fs::path path = folder.path() / "kept";
  fs::create_directories(path / "not_empty");  // a folder of that name cannot be replaced by a file
  const Error error = WriteTextFile(path, "new");
  EXPECT_NE(error.message.find(path.string()), std::string::npos);
  EXPECT_TRUE(fs::exists(path / "not_empty"));
  EXPECT_EQ(FilesIn(folder.path()), 1u);
}

TEST(File, MissingAndFolderAreNamed) {
  std::string text;
  EXPECT_NE(ReadTextFile("/no/such/file", &text).message.find("/no/such/file: no such file"), std::string::npos);
  EXPECT_NE(ReadTextFile("/", &text).message.find("folder"), std::string::npos);
}

TEST(File, ADeviceOrPipeIsNoInput) {
  TemporaryFolder folder;
  const fs::path pipe = folder.path() / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  std::string text;
  for (const fs::path& path : {fs::path("/dev/zero"), pipe})  // the one never ends, the other never begins
    EXPECT_NE(ReadTextFile(path, &text).message.find("device, pipe or socket"), std::string::npos) << path;
}

TEST(File, APipeIsWrittenIntoAndStaysOne) {
  TemporaryFolder folder;
  const fs::path pipe = folder.path() / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_NE(WriteTextFile(pipe, "lost").message.find("nobody reads"), std::string::npos);
  const int reader = ::open(pipe.c_str(), O_RDONLY | O_NONBLOCK);
  ASSERT_GE(reader, 0);
  EXPECT_EQ(WriteTextFile(pipe, "rows").message, "");
  char got[16] = {};
  EXPECT_EQ(::read(reader, got, sizeof got), 4);
  ::close(reader);
  EXPECT_EQ(std::string(got), "rows");
  EXPECT_TRUE(fs::is_fifo(pipe));
  EXPECT_EQ(FilesIn(folder.path()), 1u);
}

TEST(File, ADeviceStaysADevice) {
  TemporaryFolder folder;
  const fs::path null = folder.path() / "null";
  if (::mknod(null.c_str(), S_IFCHR | 0666, makedev(1, 3)) != 0 || ::access(null.c_str(), W_OK) != 0)
    GTEST_SKIP() << "only root makes devices";
  const int opened = ::open(null.c_str(), O_WRONLY);
  if (opened < 0) GTEST_SKIP() << "devices do not work here";
  ::close(opened);
  EXPECT_EQ(CheckWritable(null).message, "");
  EXPECT_EQ(WriteTextFile(null, "gone").message, "");
  EXPECT_TRUE(fs::is_character_file(null));
  EXPECT_NE(CheckReplaceable(null).message.find("device"), std::string::npos);
}

TEST(File, ALinkStaysAndItsTargetIsWritten) {
  TemporaryFolder folder;
  const fs::path there = folder.path() / "elsewhere" / "there", link = folder.path() / "link";
  ASSERT_EQ(WriteTextFile(there, "old").message, "");
  fs::create_symlink(there, link);
  ASSERT_EQ(WriteTextFile(link, "new").message, "");
  std::string text;
  EXPECT_EQ(ReadTextFile(there, &text).message, "");
  EXPECT_EQ(text, "new");
  EXPECT_TRUE(fs::is_symlink(link));
}

// Whoever may write to the folder could lay links where a name is to be expected.
TEST(File, NothingIsWrittenThroughALinkUnderATemporaryName) {
  TemporaryFolder folder;
  const fs::path victim = folder.path() / "victim", out = folder.path() / "out";
  ASSERT_EQ(WriteTextFile(victim, "whole").message, "");
  const std::string part = out.string() + ".part-" + std::to_string(::getpid());
  for (const char* end : {"", "-0", "-1"}) fs::create_symlink(victim, part + end);
  ASSERT_EQ(WriteTextFile(out, "one").message, "");
  ASSERT_EQ(WriteTextFile(out, "two").message, "");
  std::string text;
  EXPECT_EQ(ReadTextFile(victim, &text).message, "");
  EXPECT_EQ(text, "whole");
  EXPECT_EQ(ReadTextFile(out, &text).message, "");
  EXPECT_EQ(text, "two");
}

TEST(File, NothingIsLeftOfWhatWasNotFinished) {
  TemporaryFolder folder;
  const fs::path path = folder.path() / "film";
  ASSERT_EQ(WriteTextFile(path, "old").message, "");
  {
    UnfinishedFile file;
    ASSERT_EQ(file.Start(path).message, "");
    ASSERT_EQ(::write(file.descriptor(), "new", 3), 3);
  }
  std::string text;
  EXPECT_EQ(ReadTextFile(path, &text).message, "");
  EXPECT_EQ(text, "old");
  EXPECT_EQ(FilesIn(folder.path()), 1u);
}

TEST(Text, ALongComplaintIsCutOff) {
  const std::string line = OneLine(std::string(300'000'000, 'a'));
  EXPECT_LT(line.size(), kMostMessage_bytes + 10);
  EXPECT_EQ(line.substr(line.size() - 5), "a ...");
  std::string letters;
  for (size_t i = 0; i < kMostMessage_bytes; ++i) letters += "\u00fc";
  const std::string cut = OneLine("a" + letters);
  EXPECT_EQ(static_cast<unsigned char>(cut[cut.size() - 5]) & 0xC0, 0x80) << "letters stay whole";
}

TEST(Draco, TellsItsSizeBeforeItIsDecoded) {
  const std::vector<uint8_t> sequential{'D', 'R', 'A', 'C', 'O', 2, 2, 1, 0, 0, 0, 0x85, 0x02, 0x07};
  const auto size = DracoSizeOf(sequential);
  ASSERT_TRUE(size);
  EXPECT_EQ(size->faces, 261u);
  EXPECT_EQ(size->vertices, 7u);
  const std::vector<uint8_t> edge_breaker{'D', 'R', 'A', 'C', 'O', 2, 2, 1, 1, 0, 0, 0, 0x07, 0x85, 0x02};
  EXPECT_EQ(DracoSizeOf(edge_breaker)->faces, 261u);
  for (size_t bytes = 0; bytes < sequential.size(); ++bytes)
    EXPECT_FALSE(DracoSizeOf(std::span(sequential).first(bytes))) << bytes;
}

TEST(Text, SuggestsTheNearestNameOnly) {
  const std::vector<std::string> names{"clearance_m", "people", "seed"};
  EXPECT_EQ(NearestName("clearence_m", names), "clearance_m");
  EXPECT_EQ(NearestName("poeple", names), "people");
  EXPECT_EQ(NearestName("quite_different", names), "");
  EXPECT_EQ(OneLine("a\nb\r\n"), "a b");
}

Mat4 RandomTransform(std::mt19937& random) {
  std::uniform_real_distribution<float> u(-1, 1);
  const Quat q = Normalized(Quat{u(random), u(random), u(random), u(random)});
  return FromTranslationRotationScale({u(random), u(random), u(random)}, q,
                                      {1.5f + u(random), 1.5f + u(random), -1.5f + u(random)});
}

TEST(Text, ABeginningCutsNoLetter) {
  EXPECT_EQ(Beginning("Türme", 2), "T");
  EXPECT_EQ(Beginning("Türme", 3), "Tü");
  EXPECT_EQ(Beginning("Türme", 99), "Türme");
  EXPECT_EQ(Beginning("\xF0\x9F\x8F\xB0", 3), "");
  EXPECT_EQ(Beginning("", 5), "");
}

TEST(Text, FindsWhatNestsTooDeep) {
  const auto nested = [](int depth) {
    return "{\"a\": " + std::string(static_cast<size_t>(depth - 1), '[') + "1" +
           std::string(static_cast<size_t>(depth - 1), ']') + "}";
  };
  EXPECT_FALSE(NestsTooDeep(nested(200)));
  EXPECT_TRUE(NestsTooDeep(nested(201)));
  const std::string brackets(1000, '[');
  EXPECT_FALSE(NestsTooDeep("[\"" + brackets + "\", \"\\\"" + brackets + "\"]")) << "in a string they are letters";
  std::string many = "[";
  for (int i = 0; i < 1000; ++i) many += "[1], ";
  EXPECT_FALSE(NestsTooDeep(many + "1]")) << "beside each other";
}

TEST(Text, FindsTheLineOfAKeyThatIsTooLong) {
  const auto key = [](int parts) {
    std::string words = "a";
    for (int i = 1; i < parts; ++i) words += i % 2 == 0 ? ".a" : " . a";
    return words;
  };
  EXPECT_EQ(LineOfTooLongKey("x = 1\n" + key(200) + " = 2\n"), 0);
  EXPECT_EQ(LineOfTooLongKey("x = 1\n" + key(201) + " = 2\n"), 2);
  EXPECT_EQ(LineOfTooLongKey("[" + key(201) + "]\n"), 1);
  EXPECT_EQ(LineOfTooLongKey("\n\nx = { " + key(201) + " = 2 }\n"), 3);
  const std::string dots(1000, '.');
  EXPECT_EQ(LineOfTooLongKey("# It's " + dots + "\nx = \"\\\"" + dots + "\"\ny = \"\"\"\n" + dots + "\n\"\"\"\n"), 0);
}

TEST(Math, InverseUndoesATransform) {
  std::mt19937 random(1);
  for (int i = 0; i < 100; ++i) {
    const Mat4 m = RandomTransform(random);
    const Vec3 p{1, -2, 3};
    EXPECT_LT(Length(TransformPoint(Inverse(m), TransformPoint(m, p)) - p), 1e-3f);
  }
}

TEST(Math, SlerpTakesTheShorterArcAtConstantRate) {
  const Quat a{0, 0, 0, 1};
  const Quat b{0, std::sin(0.5f), 0, std::cos(0.5f)};
  const Quat minus_b{0, -b.y, 0, -b.w};
  for (float t : {0.0f, 0.25f, 0.5f, 1.0f}) {
    EXPECT_NEAR(Slerp(a, b, t).y, std::sin(0.5f * t), 1e-5f);
    EXPECT_NEAR(Slerp(a, minus_b, t).y, std::sin(0.5f * t), 1e-5f);
  }
}

TEST(Math, AxesGoThereAndBack) {
  const Vec3 p{1, 2, 3};
  EXPECT_EQ(Length(GroundFromGltf(GltfFromGround(p)) - p), 0);
  EXPECT_EQ(GltfFromGround({0, 0, 1}).y, 1);   // up is glTF's Y
  EXPECT_EQ(GltfFromGround({0, 1, 0}).z, -1);  // north is glTF's -Z
}

}  // namespace
}  // namespace flaneur
