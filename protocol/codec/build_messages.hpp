// The messages by which a client uses the library of builds of the world: it lists builds, fetches
// the file of one, and adds its own (feature bit 17).
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "common/core/build_info.hpp"
#include "common/core/bytes.hpp"
#include "common/core/ids.hpp"

namespace runstone {

/// Asks for the newest builds of the library that fit all that is given. The server may leave an
/// earlier request unanswered.
struct BuildsRequest {
  std::uint32_t request = 1;       // from 1, ascending over all requests about builds
  std::string name, author, tag;   // as in LibraryQuery: parts of a name, a tag; empty: any
  Sequence before = kSequenceMax;  // only builds with a lower number; at least 1
  std::uint8_t count = 1;          // 1 .. kListedBuildsMax
  friend bool operator==(const BuildsRequest&, const BuildsRequest&) = default;
};

/// A build of the library, without its cells.
struct ListedBuild {
  Sequence number = 1;  // 1 .. kSequenceMax
  BuildInfo info;
  std::uint64_t touched = 1;     // cells, 1 .. volume
  std::uint64_t file_bytes = 1;  // 1 .. kLibraryFileBytesMax
  AuthorId added_by = 0;         // 0: the console
  std::string added_by_name;     // at most kPlayerNameBytesMax bytes; empty: not known
  friend bool operator==(const ListedBuild&, const ListedBuild&) = default;
};

struct Builds {
  std::uint32_t request = 1;        // the one that is answered
  std::vector<ListedBuild> builds;  // descending by number, kListedBuildsMax at most
  bool has_more = false;            // older builds fit, too
  std::uint64_t total = 0;          // builds in the library
  std::string refusal;              // why there are no builds; empty: the request was not refused
  friend bool operator==(const Builds&, const Builds&) = default;
};

/// Asks for kBuildPieceBytes of the file of a build, or for those up to its end.
struct BuildPieceRequest {
  std::uint32_t request = 1;  // as in BuildsRequest
  Sequence number = 1;        // of the build
  std::uint64_t offset = 0;   // a multiple of kBuildPieceBytes, less than kLibraryFileBytesMax
  friend bool operator==(const BuildPieceRequest&, const BuildPieceRequest&) = default;
};

struct BuildPiece {
  std::uint32_t request = 1;  // the one that is answered
  Bytes bytes;                // at most kBuildPieceBytes; none if the request was refused
  std::string refusal;
  friend bool operator==(const BuildPiece&, const BuildPiece&) = default;
};

/// Offers a build for the library. It replaces an earlier offer of the session that has not ended.
/// Uploads follow, as BuildAnswer permits.
struct BuildOffer {
  std::uint32_t request = 1;     // as in BuildsRequest
  std::uint64_t file_bytes = 1;  // 1 .. kLibraryFileBytesMax
  friend bool operator==(const BuildOffer&, const BuildOffer&) = default;
};

/// The next bytes of the file of the offer.
struct BuildUpload {
  std::uint32_t request = 1;  // of the offer
  std::uint64_t offset = 0;   // of the first byte; they follow each other without gaps
  Bytes bytes;                // 1 .. kBuildUploadBytesMax
  friend bool operator==(const BuildUpload&, const BuildUpload&) = default;
};

/// Answers an offer, each upload, and the end of the file. A client has at most 4 uploads under way
/// that were not answered.
struct BuildAnswer {
  std::uint32_t request = 1;   // of the offer
  std::uint64_t received = 0;  // bytes of the file
  Sequence number = 0;         // of the build once it is on disk, otherwise 0
  std::string refusal;         // if it is not empty, the offer has ended and nothing is added
  friend bool operator==(const BuildAnswer&, const BuildAnswer&) = default;
};

}  // namespace runstone
