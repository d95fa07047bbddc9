// Examples of docs/protocol.md: blocks of bytes with a name behind the fence. A test that compares
// them with the codec keeps the page right.
#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace runstone::test {

/// Returns the hexadecimal digits of the block that begins with "```name". In each line, a comment
/// follows two blanks or more after the digits. Throws if the page has no such block.
std::string page_example(std::string_view name);

/// Returns the names of all blocks in the order of the page. A block without a name is "".
std::vector<std::string> page_example_names();

}  // namespace runstone::test
