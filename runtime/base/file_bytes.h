// A file's content in memory.
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace flaneur {

class FileBytes {
 public:
  FileBytes() = default;
  FileBytes(FileBytes&& other) noexcept { *this = std::move(other); }
  FileBytes& operator=(FileBytes&& other) noexcept {
    owner_ = std::move(other.owner_);
    bytes_ = std::exchange(other.bytes_, {});
    return *this;
  }
  FileBytes(std::vector<uint8_t> bytes);  // takes them as they are
  // Room for so many, without a value until they are written: fresh memory costs nothing before it is touched, and then
  // often more than what is done with it. Throws std::bad_alloc.
  static FileBytes Room(size_t count);

  size_t size() const { return bytes_.size(); }
  bool empty() const { return bytes_.empty(); }
  uint8_t* data() { return bytes_.data(); }
  const uint8_t* data() const { return bytes_.data(); }
  std::span<uint8_t> span() { return bytes_; }
  std::span<const uint8_t> span() const { return bytes_; }
  void Shorten(size_t count) { bytes_ = bytes_.first(count); }  // to so many

 private:
  std::shared_ptr<void> owner_;
  std::span<uint8_t> bytes_;
};

}  // namespace flaneur
