// LayerBits: one bit for each voxel of a layer of lines, 64 voxels of a line in a word. Even and
// odd lines lie apart, so that a loop over pairs of lines reads consecutive words. Internal to
// tiles.
#pragma once
#include <algorithm>
#include <cstddef>
#include <vector>

#include "common/runs/bit_row.hpp"

namespace runstone::tiles {

class LayerBits {
 public:
  /// Makes room for `lines` lines of `words` words, and sets all words to `value`. Requires an even
  /// number of lines.
  void reset(std::size_t lines, std::size_t words, Row64 value) {
    half_ = lines / 2 + 1;
    words_.assign(words * 2 * half_, value);
  }
  void fill(Row64 value) { std::fill(words_.begin(), words_.end(), value); }

  /// Returns word `word` of the lines 0, 2, 4, and so on. One line more than there are may be read.
  const Row64* even(std::size_t word) const { return words_.data() + word * 2 * half_; }
  Row64* even(std::size_t word) { return words_.data() + word * 2 * half_; }
  /// Returns word `word` of the lines 1, 3, 5, and so on.
  const Row64* odd(std::size_t word) const { return even(word) + half_ + 1; }
  Row64* odd(std::size_t word) { return even(word) + half_ + 1; }
  /// Returns word `word` of the lines -1, 1, 3, and so on. Line -1 may be read.
  const Row64* before_even(std::size_t word) const { return even(word) + half_; }

  /// Returns the word of one line.
  Row64& at(std::size_t line, std::size_t word) { return words_[slot(line, word)]; }
  Row64 at(std::size_t line, std::size_t word) const { return words_[slot(line, word)]; }

  /// All words, in an order that is the same for equal numbers of lines and words.
  std::vector<Row64>& all() { return words_; }
  const std::vector<Row64>& all() const { return words_; }

 private:
  std::size_t slot(std::size_t line, std::size_t word) const {
    return (2 * word + (line & 1)) * half_ + ((line + 1) >> 1);
  }
  std::size_t half_ = 0;
  std::vector<Row64> words_;
};

}  // namespace runstone::tiles
