#include "pipeline/core/store.h"

#include <gtest/gtest.h>

#include <atomic>
#include <string>
#include <thread>
#include <vector>

#include "pipeline/core/fingerprint.h"
#include "pipeline/core/temporary_folder.h"
#include "runtime/base/file.h"

namespace flaneur {
namespace {

class StoreTest : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_FALSE(folder_.Create("flaneur_test_"));
    store_.folder = folder_.path() / "store";
  }

  static StoreEntry Described(const std::string& step) {
    StoreEntry entry;
    entry.step = step;
    entry.extension = ".kept";
    entry.seconds = 3;
    entry.memory_mb = 40;
    return entry;
  }
  bool Has(const std::string& key) const {
    StoreEntry entry;
    return ReadEntry(store_, key, &entry, nullptr);
  }

  TemporaryFolder folder_;
  Store store_;
  const std::string key_ = Sha256("a key"), other_ = Sha256("another");
};

TEST_F(StoreTest, GivesBackWhatWasPut) {
  ASSERT_FALSE(PutEntry(store_, key_, Described("avatar:monk"), std::string("with\0zero", 9)));
  StoreEntry entry;
  std::string content;
  ASSERT_TRUE(ReadEntry(store_, key_, &entry, &content));
  EXPECT_EQ(content, std::string("with\0zero", 9));
  EXPECT_EQ(entry.step, "avatar:monk");
  EXPECT_FALSE(Has(other_));
  double seconds = 0, memory_mb = 0;
  EXPECT_TRUE(LastTaken(store_, "avatar:monk", &seconds, &memory_mb));
  EXPECT_EQ(seconds, 3);
  EXPECT_FALSE(LastTaken(store_, "avatar:nun", &seconds, &memory_mb));
}

TEST_F(StoreTest, AnyFlippedBitCountsAsMissing) {
  ASSERT_FALSE(PutEntry(store_, key_, Described("a"), "content"));
  for (const char* extension : {".kept", ".json"}) {
    const auto file = EntryFile(store_, key_, extension);
    std::string whole;
    ASSERT_FALSE(ReadTextFile(file, &whole));
    for (size_t i = 0; i < whole.size(); ++i) {
      std::string damaged = whole;
      damaged[i] ^= 1;
      ASSERT_FALSE(PutEntry(store_, key_, Described("a"), "content"));
      ASSERT_FALSE(WriteTextFile(file, damaged));
      EXPECT_FALSE(Has(key_)) << extension << " " << i;
    }
    EXPECT_FALSE(PutEntry(store_, key_, Described("a"), "content"));
    EXPECT_TRUE(Has(key_)) << "made again";
  }
}

TEST_F(StoreTest, ManyWhoMakeTheSameAtOnceAllFindItWhole) {
  std::atomic<int> missing = 0, failed = 0;
  std::vector<std::thread> writers;
  for (int writer = 0; writer < 4; ++writer) {
    writers.emplace_back([&, writer] {
      for (int round = 0; round < 50; ++round) {
        const std::string key = Sha256(std::to_string(round));
        if (Has(key)) continue;
        failed += static_cast<bool>(PutEntry(store_, key, Described("a"), std::string(1000 + writer, 'x')));
        missing += !Has(key);
      }
    });
  }
  for (std::thread& writer : writers) writer.join();
  EXPECT_EQ(failed, 0);
  EXPECT_EQ(missing, 0);
}

TEST_F(StoreTest, CountsOnlyWhileTheFilesThatWereReadAreTheSame) {
  const auto read = folder_.path() / "read.txt";
  ASSERT_FALSE(WriteTextFile(read, "one"));
  StoreEntry entry = Described("source:town");
  entry.reads = {{read.string(), Sha256("one")}};
  ASSERT_FALSE(PutEntry(store_, key_, entry, "made of one"));
  EXPECT_TRUE(Has(key_));
  ASSERT_FALSE(WriteTextFile(read, "two"));
  EXPECT_FALSE(Has(key_));
}

TEST_F(StoreTest, IsListedVerifiedAndTrimmed) {
  ASSERT_FALSE(PutEntry(store_, key_, Described("a"), "content"));
  ASSERT_FALSE(PutEntry(store_, other_, Described("b"), std::string(1000, 'x')));
  EXPECT_EQ(ListStore(store_).size(), 2u);
  EXPECT_EQ(VerifyStore(store_), 0u);
  ASSERT_FALSE(WriteTextFile(EntryFile(store_, other_, ".kept"), std::string(1000, 'y')));
  EXPECT_EQ(VerifyStore(store_), 1u);
  EXPECT_EQ(ListStore(store_).size(), 1u);
  EXPECT_EQ(TrimStore(store_, 1000000, 1), 0u);
  EXPECT_EQ(TrimStore(store_, 0, 1), 1u);
  EXPECT_EQ(ListStore(store_).size(), 0u);
}

}  // namespace
}  // namespace flaneur
