// Folded names: two names of players are the same name if their folded forms are equal. The form is
// NFKC_Casefold of Unicode (compatibility characters, case, combining order, invisible characters),
// made by utf8proc, with each run of blanks as one blank and none at the ends.
// Versions: Unicode guarantees that this form never changes for a text of assigned characters
// (Unicode Character Encoding Stability Policies, "Normalization" and "Case Folding"). name_fault()
// refuses other characters, so a form that a store keeps stays valid under later releases.
// Sources: Unicode Standard Annex #15 and #31; the refused mixtures follow Unicode Technical
// Standard #39, "Mixed-Script Detection".
#pragma once
#include <optional>
#include <string>
#include <string_view>

namespace runstone {

/// Returns the folded form. It is idempotent, and equal for all normal forms of a text. It has at
/// most about twelve times as many bytes as the text. Requires well-formed UTF-8. Cost: O(bytes).
std::string folded_name(std::string_view name);

/// Returns why a player may not have this name, as the end of the sentence "the name is refused: ",
/// or nullopt. Refused are
///   - texts that are not is_plain_name();
///   - names with characters that this release of Unicode does not know, or of private use;
///   - names that begin with a combining mark, because it changes the character before the name;
///   - names with letters of two of the scripts Latin, Greek and Cyrillic, because many of their
///     letters look the same. A name wholly in one script may still look like a name in another.
/// Cost: O(bytes).
std::optional<std::string> name_fault(std::string_view name);

}  // namespace runstone
