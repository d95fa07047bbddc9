// The skeleton of a name: names that look the same have the same one (Unicode Technical Standard
// #39, "Confusable Detection"), made by ICU. Only letters and digits count, so "[ADM1N]" looks like
// "admin". A skeleton is compared within one run of the program and never stored: the tables behind
// it change with each release of Unicode.
#pragma once
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace runstone {

/// The skeletons of a text: of the text as it is written, and of its folded form (folded_name). Two
/// texts look alike if they have one in common that is not empty.
struct Skeletons {
  std::string written, folded;
};

/// Requires well-formed UTF-8. Cost: O(bytes), some microseconds. The skeletons of two words, one
/// after another, are those of the words without the blank between them.
Skeletons skeletons_of(std::string_view text);

/// Returns the skeletons of a name that is to be protected: also that of its upper case, in which
/// "I", "l" and "1" look the same. None is empty.
std::set<std::string> protected_skeletons_of(std::string_view name);

/// Returns the parts of a text between blanks and other characters that are no letters and digits.
/// Combining marks and characters of no width part no words. Requires well-formed UTF-8.
std::vector<std::string> name_words(std::string_view text);

}  // namespace runstone
