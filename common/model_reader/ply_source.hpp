// PlySource: the numbers of a .ply behind its head, in each of its three encodings. Thread: one. Calls
// block on the disk.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "common/model_reader/model_folder.hpp"
#include "common/model_reader/ply_head.hpp"

namespace runstone {

class PlySource {
 public:
  /// `file` must outlive this object.
  explicit PlySource(const OpenedFile& file) : file_(file), buffer_(64 * 1024) {}

  /// Reads a line of the head, of at most 4 KiB, without its end. Returns false at the end of the file.
  bool line(std::string& to);
  /// Sets the encoding of the numbers behind the head.
  void set_body(PlyBody body) { body_ = body; }
  /// Reads a number. Returns false at the end of the file, or if a text is no number.
  bool number(PlyType type, double& to);
  /// Returns the bytes of the file that are not read yet.
  std::uint64_t left() const { return file_.bytes() - offset_ + (end_ - begin_); }

 private:
  int next();
  bool text_number(double& to);

  const OpenedFile& file_;
  std::vector<std::uint8_t> buffer_;
  std::size_t begin_ = 0, end_ = 0;
  std::uint64_t offset_ = 0;  // of the end of the buffer
  PlyBody body_ = PlyBody::text;
};

}  // namespace runstone
