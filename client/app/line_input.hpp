// LineInput: the lines that a person types, read without waiting. One thread.
#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace runstone {

class LineInput {
 public:
  /// Reads from the descriptor, which must outlive the object. A process in the background of a
  /// terminal reads nothing and is not stopped.
  explicit LineInput(int descriptor);

  /// Returns the lines that are complete, without line breaks. Bytes of a line beyond
  /// kCommandBytesMax are left out. After the end of the input or an error it returns no more
  /// lines.
  std::vector<std::string> take_lines();

 private:
  void take(std::string_view bytes, std::vector<std::string>& lines);

  int descriptor_;  // -1 after the end
  std::string line_;
};

}  // namespace runstone
