// Golden vectors: bytes and results of the formats as JSON files, for implementations in other
// languages. The library makes them, and a test compares the files in tests/conformance/files with
// what it makes, so a change of a format is a failed test. docs/conformance.md describes the files.
#pragma once
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace runstone::conformance {

/// The fields keep the order in which they were added.
using Json = nlohmann::ordered_json;

struct VectorFile {
  std::string name;  // such as "chunks.json"
  Json content;
};

/// Makes all files. They depend on nothing but the library.
std::vector<VectorFile> vector_files();

/// Returns the text of a file: one line for each vector.
std::string text_of(const Json& content);

/// Compares a file that was kept with its content now. Returns the first difference in words, or
/// nullopt if there is none. Bytes of messages may differ, because releases of FlatBuffers arrange
/// fields differently: they are decoded and compared by their values.
std::optional<std::string> difference(const VectorFile& now, std::string_view kept);

// The contents of the files.
Json chunk_vectors();
Json edit_vectors();
Json border_vectors();
Json tile_vectors();
Json handshake_vectors();

}  // namespace runstone::conformance
