// Which values are refused of marks of the log and of previews of rollbacks.
#include <string>
#include <vector>

#include "tests/unit/protocol/codec/built_message.hpp"

namespace runstone::test {
namespace {

struct LogMarksRequestFields {
  std::uint32_t request = 1;
  std::uint64_t first = 1, last = 9;
  std::uint8_t count = 5;
  wire::Corner at{1, -2, 3};
  Offset<wire::LogMarksRequest> operator()(FlatBufferBuilder& b) const {
    return wire::CreateLogMarksRequest(b, request, first, last, count, &at);
  }
};

struct LogMarksFields {
  std::uint32_t request = 1;
  std::uint64_t first = 1;
  std::vector<wire::LogMark> marks = {{5, 1'000, 7, 0, 2}, {6, 2'000, 0, 1, 1}};
  std::vector<std::pair<std::uint32_t, std::string>> authors = {{7, "ann"}, {9, "bob"}};
  std::string refused;
  Offset<wire::LogMarks> operator()(FlatBufferBuilder& b) const {
    std::vector<Offset<wire::LogAuthor>> names;
    for (const auto& [author, name] : authors)
      names.push_back(wire::CreateLogAuthor(b, author, b.CreateString(name)));
    const auto marks_at = b.CreateVectorOfStructs(marks);
    const auto names_at = b.CreateVector(names);
    return wire::CreateLogMarks(b, request, first, marks_at, names_at, b.CreateString(refused));
  }
};

struct RestorePreviewFields {
  std::string preview = "p1";
  std::vector<Bytes> edits = {encode(EditDescriptor{SetVoxel{{1, 2, 3}}, {}, 4})};
  Offset<wire::RestorePreview> operator()(FlatBufferBuilder& b) const {
    std::vector<Offset<wire::EditBytes>> list;
    for (const Bytes& edit : edits)
      list.push_back(wire::CreateEditBytes(b, b.CreateVector(edit.data(), edit.size())));
    const auto id = b.CreateString(preview);
    return wire::CreateRestorePreview(b, 3, id, 4, 5, b.CreateVector(list), false);
  }
};

}  // namespace

TEST_CASE("a request for log marks is refused with a bad number, range, count or place",
          "[protocol]") {
  refuses<LogMarksRequest, LogMarksRequestFields>({
      [](auto& r) { r.request = 0; },
      [](auto& r) { r.first = 0; },
      [](auto& r) { r.first = 10; },
      [](auto& r) { r.last = kSequenceMax + 1; },
      [](auto& r) { r.count = 0; },
      [](auto& r) { r.count = kLogMarksMax + 1; },
      [](auto& r) { r.at = {kWorldLimit, 0, 0}; },
      [](auto& r) { r.at = {0, -kWorldLimit - 1, 0}; },
  });
}

TEST_CASE("log marks are refused out of order, and with bad fields", "[protocol]") {
  refuses<LogMarks, LogMarksFields>({
      [](auto& m) { m.request = 0; },
      [](auto& m) { m.first = 0; },
      [](auto& m) { m.first = kSequenceMax + 1; },
      [](auto& m) { m.marks[0] = {0, 0, 7, 0, 2}; },
      [](auto& m) { m.marks[0] = {6, 0, 7, 0, 2}; },
      [](auto& m) { m.marks[1] = {kSequenceMax + 1, 0, 7, 0, 2}; },
      [](auto& m) { m.marks[1] = {6, kWireTimeUsMax + 1, 7, 0, 2}; },
      [](auto& m) { m.marks[1] = {6, 0, 7, kCauseMax + 1, 2}; },
      [](auto& m) { m.marks[1] = {6, 0, 7, 0, 0}; },
      [](auto& m) {
        m.marks.clear();
        for (std::uint64_t seq = 1; seq <= kLogMarksMax + 1; ++seq)
          m.marks.emplace_back(seq, 0, 7, std::uint8_t{0}, std::uint8_t{2});
      },
      [](auto& m) { m.authors[0].first = 0; },
      [](auto& m) { m.authors[1].first = 7; },
      [](auto& m) { m.authors[0].second = ""; },
      [](auto& m) { m.authors[0].second = std::string(33, 'a'); },
      [](auto& m) { m.authors[0].second = "a\nb"; },
      [](auto& m) { m.refused = "no"; },
      [](auto& m) { m.refused = std::string(kTextBytesMax + 1, 'a'); },
  });
}

TEST_CASE("a preview of a rollback is refused with bad edits, or too many", "[protocol]") {
  refuses<RestorePreview, RestorePreviewFields>({
      [](auto& p) { p.preview = std::string(kPreviewIdBytesMax + 1, 'p'); },
      [](auto& p) { p.preview = "p\x01"; },
      [](auto& p) { p.edits[0].pop_back(); },
      [](auto& p) { p.edits[0].push_back(0); },
      [](auto& p) { p.edits.emplace_back(); },
      [](auto& p) { p.edits[0] = encode(rights_edit(RemoveRole{"guest"})); },
      [](auto& p) { p.edits.resize(kRestorePreviewEditsMax + 1, p.edits[0]); },
  });
}

}  // namespace runstone::test
