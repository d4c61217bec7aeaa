#include "pipeline/io/etc1s.h"

#include <algorithm>

#include "pipeline/io/bits.h"
#include "runtime/base/array.h"

namespace flaneur {
namespace {

constexpr uint32_t kNoSymbol = 0xFFFFFFFF;

Error Broken(const char* what) { return Fail(std::string("its ") + what + " are cut short or damaged"); }

// Canonical codes, as Deflate's. False where there are more codes than bits for them.
bool BuildTable(const std::vector<uint8_t>& lengths, HuffmanTable* table) {
  *table = {};
  for (const uint8_t length : lengths) ++table->count_of_length[length];
  table->count_of_length[0] = 0;
  uint32_t left = 1;
  for (size_t length = 1; length < table->count_of_length.size(); ++length) {
    left *= 2;
    if (table->count_of_length[length] > left) return false;
    left -= table->count_of_length[length];
  }
  for (size_t length = 1; length < table->count_of_length.size(); ++length) {
    for (size_t symbol = 0; symbol < lengths.size(); ++symbol) {
      if (lengths[symbol] == length) table->symbols.push_back(static_cast<uint16_t>(symbol));
    }
  }
  return true;
}

// kNoSymbol where the bits are no code; the reader then counts as ended.
uint32_t Decode(const HuffmanTable& table, BitReader* bits) {
  uint32_t code = 0, first = 0, index = 0;
  for (size_t length = 1; length < table.count_of_length.size() && !bits->ended; ++length) {
    code = 2 * code + bits->Take(1);
    first *= 2;
    const uint32_t count = table.count_of_length[length];
    if (code - first < count) return table.symbols[index + code - first];
    index += count, first += count;
  }
  bits->ended = true;
  return kNoSymbol;
}

// Lengths of a table's codes, packed by a table of their own: a length, or a run of zeros or of the one before.
bool ReadLengths(const HuffmanTable& packed, size_t count, BitReader* bits, std::vector<uint8_t>* lengths) {
  struct Run {
    int bits;
    uint32_t least;
    bool of_zeros;
  };
  static constexpr std::array<Run, 4> kRuns{{{3, 3, true}, {7, 11, true}, {2, 3, false}, {7, 7, false}}};
  while (lengths->size() < count && !bits->ended) {
    const uint32_t symbol = Decode(packed, bits);
    if (symbol <= 16) {
      lengths->push_back(static_cast<uint8_t>(symbol));
      continue;
    }
    if (symbol > 20) return false;
    const Run& run = kRuns[symbol - 17];
    const bool known = !lengths->empty() && lengths->back() > 0;
    if (!run.of_zeros && !known) return false;
    lengths->insert(lengths->end(), bits->Take(run.bits) + run.least, run.of_zeros ? uint8_t{0} : lengths->back());
  }
  return !bits->ended && lengths->size() == count;
}

bool ReadTable(BitReader* bits, HuffmanTable* table) {
  static constexpr std::array<uint8_t, 21> kOrder{17, 18, 19, 20, 0,  8, 7,  9, 6,  10, 5,
                                                  11, 4,  12, 3,  13, 2, 14, 1, 15, 16};
  *table = {};
  const size_t count = bits->Take(14);
  if (count == 0) return !bits->ended;
  const size_t packed_count = bits->Take(5);
  if (packed_count < 1 || packed_count > kOrder.size()) return false;
  std::vector<uint8_t> packed_lengths(kOrder.size()), lengths;
  for (size_t i = 0; i < packed_count; ++i) packed_lengths[kOrder[i]] = static_cast<uint8_t>(bits->Take(3));
  HuffmanTable packed;
  return BuildTable(packed_lengths, &packed) && ReadLengths(packed, count, bits, &lengths) &&
         BuildTable(lengths, table);
}

bool ReadColors(std::span<const uint8_t> bytes, std::vector<Etc1sColor>* colors) {
  BitReader bits{bytes};
  std::array<HuffmanTable, 3> step;  // from a dark value, a middle one, a bright one
  HuffmanTable contrast;
  for (HuffmanTable& table : step) {
    if (!ReadTable(&bits, &table)) return false;
  }
  if (!ReadTable(&bits, &contrast)) return false;
  const bool grey = bits.Take(1) != 0;
  Etc1sColor before{{16, 16, 16}, 0};
  for (Etc1sColor& color : *colors) {
    color.contrast = static_cast<uint8_t>((before.contrast + Decode(contrast, &bits)) & 7);
    for (size_t c = 0; c < (grey ? 1 : 3); ++c) {
      const size_t range = before.rgb[c] <= 9 ? 0 : before.rgb[c] <= 21 ? 1 : 2;
      color.rgb[c] = static_cast<uint8_t>((before.rgb[c] + Decode(step[range], &bits)) & 31);
    }
    if (grey) color.rgb[1] = color.rgb[2] = color.rgb[0];
    if (bits.ended) return false;
    before = color;
  }
  return true;
}

bool ReadPatterns(std::span<const uint8_t> bytes, std::vector<std::array<uint8_t, 4>>* patterns) {
  BitReader bits{bytes};
  if (bits.Take(2) != 0) return false;
  const bool plain = bits.Take(1) != 0;
  HuffmanTable change;
  if (!plain && !ReadTable(&bits, &change)) return false;
  std::array<uint8_t, 4> before{};
  for (size_t i = 0; i < patterns->size(); ++i) {
    for (size_t row = 0; row < 4; ++row) {
      const uint32_t next = plain || i == 0 ? bits.Take(8) : before[row] ^ Decode(change, &bits);
      before[row] = static_cast<uint8_t>(next);
    }
    if (bits.ended) return false;
    (*patterns)[i] = before;
  }
  return true;
}

// Patterns used of late: one that is used again moves half the way to the front.
struct History {
  std::vector<uint32_t> patterns;
  size_t next = 0;

  explicit History(size_t size) : patterns(size), next(size / 2) {}
  void Add(uint32_t pattern) {
    if (patterns.empty()) return;
    patterns[next] = pattern;
    if (++next == patterns.size()) next = patterns.size() / 2;
  }
  uint32_t Use(size_t place) {
    const uint32_t pattern = patterns[place];
    std::swap(patterns[place / 2], patterns[place]);
    return pattern;
  }
};

// A number in pieces of so many bits, each with one more that says whether another follows.
uint32_t TakePieces(int piece_bits, BitReader* bits) {
  uint32_t value = 0;
  for (int shift = 0; shift < 32; shift += piece_bits) {
    value |= bits->Take(piece_bits) << shift;
    if (bits->Take(1) == 0) break;
  }
  return value;
}

// Two bits a block say where its colour comes from; a symbol is for two by two blocks, and may be meant for many more.
class Predictions {
 public:
  Predictions(const HuffmanTable& table, int blocks_x) : table_(table), below_(static_cast<size_t>(blocks_x + 1) / 2) {}

  uint32_t Of(int x, int y, BitReader* bits) {
    uint8_t& below = below_[static_cast<size_t>(x) / 2];
    if (x % 2 == 0) {
      now_ = y % 2 == 0 ? Next(bits) : below;
      if (y % 2 == 0) below = static_cast<uint8_t>(now_ >> 4);
    }
    const uint32_t prediction = now_ & 3;
    now_ >>= 2;
    return prediction;
  }

 private:
  static constexpr uint32_t kAgain = 256, kLeastRun = 3;

  uint32_t Next(BitReader* bits) {
    if (run_ > 0) {
      --run_;
      return last_;
    }
    const uint32_t symbol = Decode(table_, bits);
    if (symbol < kAgain) last_ = symbol;
    if (symbol == kAgain) run_ = TakePieces(4, bits) + kLeastRun - 1;
    if (symbol > kAgain) bits->ended = true;
    return last_;
  }

  const HuffmanTable& table_;
  std::vector<uint8_t> below_;
  uint32_t now_ = 0, last_ = 0, run_ = 0;
};

class Colors {
 public:
  Colors(const Etc1sBooks& books, int blocks_x) : books_(books), above_(static_cast<size_t>(blocks_x)) {}

  uint32_t Of(int x, int y, uint32_t prediction, BitReader* bits) {
    enum : uint32_t { kLeft, kAbove, kAboveLeft, kStep };
    const size_t column = static_cast<size_t>(x);
    if ((prediction == kLeft && x == 0) || (prediction == kAbove && y == 0) ||
        (prediction == kAboveLeft && (x == 0 || y == 0)))
      bits->ended = true;
    const uint32_t above_left = x > 0 ? above_left_ : 0;
    above_left_ = above_[column];
    if (prediction == kAbove) last_ = above_[column];
    if (prediction == kAboveLeft) last_ = above_left;
    if (prediction == kStep) {
      last_ += Decode(books_.color_step, bits);
      if (last_ >= books_.colors.size()) last_ -= static_cast<uint32_t>(books_.colors.size());
    }
    if (last_ >= books_.colors.size()) bits->ended = true;
    above_[column] = last_;
    return last_;
  }

 private:
  const Etc1sBooks& books_;
  std::vector<uint32_t> above_;  // of the row before, and of this one as far as it is read
  uint32_t above_left_ = 0, last_ = 0;
};

class Patterns {
 public:
  explicit Patterns(const Etc1sBooks& books) : books_(books), history_(books.history) {}

  uint32_t Next(BitReader* bits) {
    const uint32_t known = static_cast<uint32_t>(books_.patterns.size());
    uint32_t symbol = known;
    if (run_ > 0) {
      --run_;
    } else {
      symbol = Decode(books_.pattern, bits);
      if (symbol == known + books_.history) symbol = known, run_ = ReadRun(bits) - 1;
    }
    if (symbol < known) {
      history_.Add(symbol);
      return symbol;
    }
    if (symbol - known < history_.patterns.size()) return history_.Use(symbol - known);
    bits->ended = true;
    return 0;
  }

 private:
  uint32_t ReadRun(BitReader* bits) {
    constexpr uint32_t kLong = 63, kLeastRun = 3;
    const uint32_t run = Decode(books_.run, bits);
    return run == kNoSymbol ? kLeastRun : (run == kLong ? TakePieces(7, bits) : run) + kLeastRun;
  }

  const Etc1sBooks& books_;
  History history_;
  uint32_t run_ = 0;
};

// ETC1's intensities, darkest first.
constexpr std::array<std::array<int, 4>, 8> kContrasts{{{-8, -2, 2, 8},
                                                        {-17, -5, 5, 17},
                                                        {-29, -9, 9, 29},
                                                        {-42, -13, 13, 42},
                                                        {-60, -18, 18, 60},
                                                        {-80, -24, 24, 80},
                                                        {-106, -33, 33, 106},
                                                        {-183, -47, 47, 183}}};

void DrawBlock(const Etc1sColor& color, const std::array<uint8_t, 4>& pattern, size_t row_bytes, uint8_t* first) {
  for (size_t texel = 0; texel < 16; ++texel) {
    const size_t step = pattern[texel / 4] >> (2 * (texel % 4)) & 3u;
    uint8_t* rgb = first + texel / 4 * row_bytes + 3 * (texel % 4);
    for (size_t c = 0; c < 3; ++c) {
      const int base = color.rgb[c] << 3 | color.rgb[c] >> 2;
      rgb[c] = static_cast<uint8_t>(std::clamp(base + kContrasts[color.contrast][step], 0, 255));
    }
  }
}

}  // namespace

Error ReadEtc1sBooks(size_t colors, std::span<const uint8_t> color_bytes, size_t patterns,
                     std::span<const uint8_t> pattern_bytes, std::span<const uint8_t> table_bytes, Etc1sBooks* books) {
  books->colors.resize(colors);
  books->patterns.resize(patterns);
  if (!ReadColors(color_bytes, &books->colors)) return Broken("colours");
  if (!ReadPatterns(pattern_bytes, &books->patterns)) return Broken("patterns");
  BitReader bits{table_bytes};
  for (HuffmanTable* table : {&books->prediction, &books->color_step, &books->pattern, &books->run}) {
    if (!ReadTable(&bits, table)) return Broken("tables");
  }
  books->history = bits.Take(13);
  return bits.ended ? Broken("tables") : Ok();
}

Error DecodeEtc1sSlice(const Etc1sBooks& books, std::span<const uint8_t> bytes, int blocks_x, int blocks_y,
                       std::vector<uint8_t>* rgb) {
  const size_t row_bytes = 12 * static_cast<size_t>(blocks_x);
  rgb->assign(4 * row_bytes * static_cast<size_t>(blocks_y), 0);
  BitReader bits{bytes};
  Predictions predictions(books.prediction, blocks_x);
  Colors colors(books, blocks_x);
  Patterns patterns(books);
  for (int y = 0; y < blocks_y; ++y) {
    for (int x = 0; x < blocks_x; ++x) {
      const uint32_t color = colors.Of(x, y, predictions.Of(x, y, &bits), &bits), pattern = patterns.Next(&bits);
      if (bits.ended) return Broken("blocks");
      DrawBlock(books.colors[color], books.patterns[pattern], row_bytes,
                rgb->data() + 4 * row_bytes * static_cast<size_t>(y) + 12 * static_cast<size_t>(x));
    }
  }
  return Ok();
}

}  // namespace flaneur
