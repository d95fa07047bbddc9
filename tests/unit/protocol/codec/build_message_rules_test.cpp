// Which values are refused of the messages about builds of the library.
#include <string>
#include <vector>

#include "common/edits/descriptor/library_change.hpp"
#include "tests/unit/protocol/codec/built_message.hpp"

namespace runstone::test {
namespace {

BuildInfo a_build_info() {
  BuildInfo info;
  info.name = "mill";
  info.sides = {4, 3, 2};
  return info;
}

Bytes bytes_of_info(const BuildInfo& info) {
  Bytes bytes;
  ByteWriter w(bytes);
  write_build_info(w, info);
  return bytes;
}

Offset<flatbuffers::Vector<std::uint8_t>> vector_of(FlatBufferBuilder& b, const Bytes& bytes) {
  return b.CreateVector(bytes.data(), bytes.size());
}

struct BuildsRequestFields {
  std::uint32_t request = 1;
  std::string name, author, tag;
  std::uint64_t before = 9;
  std::uint8_t count = 5;
  Offset<wire::BuildsRequest> operator()(FlatBufferBuilder& b) const {
    const auto name_at = b.CreateString(name);
    const auto author_at = b.CreateString(author);
    const auto tag_at = b.CreateString(tag);
    return wire::CreateBuildsRequest(b, request, name_at, author_at, tag_at, before, count);
  }
};

struct BuildsFields {
  std::uint32_t request = 1;
  std::vector<std::uint64_t> numbers = {9, 5};
  Bytes info = bytes_of_info(a_build_info());
  std::uint64_t touched = 24, file_bytes = 500;
  std::string added_by_name = "ann", refused;
  Offset<wire::Builds> operator()(FlatBufferBuilder& b) const {
    std::vector<Offset<wire::ListedBuild>> rows;
    for (const std::uint64_t number : numbers) {
      const auto info_at = vector_of(b, info);
      const auto name_at = b.CreateString(added_by_name);
      rows.push_back(wire::CreateListedBuild(b, number, info_at, touched, file_bytes, 7, name_at));
    }
    const auto rows_at = b.CreateVector(rows);
    return wire::CreateBuilds(b, request, rows_at, false, 2, b.CreateString(refused));
  }
};

struct BuildPieceRequestFields {
  std::uint32_t request = 1;
  std::uint64_t number = 5, offset = kBuildPieceBytes;
  Offset<wire::BuildPieceRequest> operator()(FlatBufferBuilder& b) const {
    return wire::CreateBuildPieceRequest(b, request, number, offset);
  }
};

struct BuildPieceFields {
  std::uint32_t request = 1;
  Bytes bytes = {1, 2, 3};
  std::string refused;
  Offset<wire::BuildPiece> operator()(FlatBufferBuilder& b) const {
    const auto bytes_at = vector_of(b, bytes);
    return wire::CreateBuildPiece(b, request, bytes_at, b.CreateString(refused));
  }
};

struct BuildOfferFields {
  std::uint32_t request = 1;
  std::uint64_t file_bytes = kLibraryFileBytesMax;
  Offset<wire::BuildOffer> operator()(FlatBufferBuilder& b) const {
    return wire::CreateBuildOffer(b, request, file_bytes);
  }
};

struct BuildUploadFields {
  std::uint32_t request = 1;
  std::uint64_t offset = kLibraryFileBytesMax - 1;
  Bytes bytes = Bytes(kBuildUploadBytesMax, 1);
  Offset<wire::BuildUpload> operator()(FlatBufferBuilder& b) const {
    return wire::CreateBuildUpload(b, request, offset, vector_of(b, bytes));
  }
};

struct BuildAnswerFields {
  std::uint32_t request = 1;
  std::uint64_t received = kLibraryFileBytesMax, number = 0;
  std::string refused;
  Offset<wire::BuildAnswer> operator()(FlatBufferBuilder& b) const {
    return wire::CreateBuildAnswer(b, request, received, number, b.CreateString(refused));
  }
};

}  // namespace

TEST_CASE("a request for builds is refused with a bad number, text or count", "[protocol]") {
  refuses<BuildsRequest, BuildsRequestFields>({
      [](auto& r) { r.request = 0; },
      [](auto& r) { r.before = 0; },
      [](auto& r) { r.before = kSequenceMax + 1; },
      [](auto& r) { r.count = 0; },
      [](auto& r) { r.count = kListedBuildsMax + 1; },
      [](auto& r) { r.name = std::string(kBuildNameBytesMax + 1, 'a'); },
      [](auto& r) { r.author = std::string(kBuildAuthorBytesMax + 1, 'a'); },
      [](auto& r) { r.tag = std::string(kBuildTagBytesMax + 1, 'a'); },
      [](auto& r) { r.tag = "a\nb"; },
  });
}

TEST_CASE("builds are refused out of order, and with bad fields", "[protocol]") {
  refuses<Builds, BuildsFields>({
      [](auto& m) { m.request = 0; },
      [](auto& m) { m.numbers = {5, 9}; },
      [](auto& m) { m.numbers = {5, 5}; },
      [](auto& m) { m.numbers = {0}; },
      [](auto& m) { m.numbers = {kSequenceMax + 1}; },
      [](auto& m) {
        m.numbers.clear();
        for (std::uint64_t n = kListedBuildsMax + 1; n != 0; --n) m.numbers.push_back(n);
      },
      [](auto& m) { m.info.pop_back(); },
      [](auto& m) { m.info.push_back(0); },
      [](auto& m) { m.info.clear(); },
      [](auto& m) { m.touched = 0; },
      [](auto& m) { m.touched = 25; },
      [](auto& m) { m.file_bytes = 0; },
      [](auto& m) { m.file_bytes = kLibraryFileBytesMax + 1; },
      [](auto& m) { m.added_by_name = std::string(kPlayerNameBytesMax + 1, 'a'); },
      [](auto& m) { m.refused = "no"; },
      [](auto& m) { m.refused = std::string(kTextBytesMax + 1, 'a'); },
  });
}

TEST_CASE("a request for a piece of a build is refused outside the file", "[protocol]") {
  refuses<BuildPieceRequest, BuildPieceRequestFields>({
      [](auto& r) { r.request = 0; },
      [](auto& r) { r.number = 0; },
      [](auto& r) { r.number = kSequenceMax + 1; },
      [](auto& r) { r.offset = 1; },
      [](auto& r) { r.offset = kLibraryFileBytesMax; },
  });
}

TEST_CASE("a piece of a build has bytes or a refusal", "[protocol]") {
  refuses<BuildPiece, BuildPieceFields>({
      [](auto& m) { m.request = 0; },
      [](auto& m) { m.bytes.clear(); },
      [](auto& m) { m.bytes.resize(kBuildPieceBytes + 1); },
      [](auto& m) { m.refused = "no"; },
      [](auto& m) {
        m.bytes.clear();
        m.refused = std::string(kTextBytesMax + 1, 'a');
      },
  });
}

TEST_CASE("offers, uploads and answers of builds are refused with bad fields", "[protocol]") {
  refuses<BuildOffer, BuildOfferFields>({
      [](auto& m) { m.request = 0; },
      [](auto& m) { m.file_bytes = 0; },
      [](auto& m) { m.file_bytes = kLibraryFileBytesMax + 1; },
  });
  refuses<BuildUpload, BuildUploadFields>({
      [](auto& m) { m.request = 0; },
      [](auto& m) { m.offset = kLibraryFileBytesMax; },
      [](auto& m) { m.bytes.clear(); },
      [](auto& m) { m.bytes.push_back(1); },
  });
  refuses<BuildAnswer, BuildAnswerFields>({
      [](auto& m) { m.request = 0; },
      [](auto& m) { m.received = kLibraryFileBytesMax + 1; },
      [](auto& m) { m.number = kSequenceMax + 1; },
      [](auto& m) { m.refused = std::string(kTextBytesMax + 1, 'a'); },
      [](auto& m) {
        m.number = 5;
        m.refused = "no";
      },
  });
}

}  // namespace runstone::test
