#include "common/edits/descriptor/library_change.hpp"

namespace runstone {
namespace {

// The tags are stored.
constexpr std::uint8_t kAddBuildTag = 1, kRemoveBuildTag = 2;

}  // namespace

Result<void> validate(const LibraryChange& change) {
  if (const auto* remove = std::get_if<RemoveBuild>(&change)) {
    if (remove->number == 0 || remove->number > kSequenceMax)
      return fail(ErrorCode::bad_value, "number of a build is outside 1 .. 2^63 - 1");
    return {};
  }
  const AddBuild& add = *std::get_if<AddBuild>(&change);
  if (auto sound = validate(add.info); !sound) return sound;
  if (add.touched == 0 || add.touched > add.info.sides.volume())
    return fail(ErrorCode::bad_value, "build has no touched cell, or more than its volume");
  if (add.file_bytes == 0 || add.file_bytes > kLibraryFileBytesMax)
    return fail(ErrorCode::limit_exceeded, "file of a build is empty or longer than 1 GiB");
  if (add.content == 0) return fail(ErrorCode::bad_value, "content of a build is 0");
  return {};
}

void write_library_change(ByteWriter& w, const LibraryChange& change) {
  if (const auto* remove = std::get_if<RemoveBuild>(&change)) {
    w.u8(kRemoveBuildTag);
    w.varint(remove->number);
    return;
  }
  const AddBuild& add = *std::get_if<AddBuild>(&change);
  w.u8(kAddBuildTag);
  write_build_info(w, add.info);
  w.varint(add.touched);
  w.varint(add.file_bytes);
  w.u64(add.file_digest);
  w.u64(add.content);
}

LibraryChange read_library_change(ByteReader& r) {
  switch (r.u8()) {
    case kAddBuildTag: {
      AddBuild add;
      add.info = read_build_info(r);
      add.touched = r.varint();
      add.file_bytes = r.varint();
      add.file_digest = r.u64();
      add.content = r.u64();
      return add;
    }
    case kRemoveBuildTag:
      return RemoveBuild{r.varint()};
    default:
      r.reject(ErrorCode::unknown_kind, "unknown change of the library");
      return RemoveBuild{};
  }
}

}  // namespace runstone
