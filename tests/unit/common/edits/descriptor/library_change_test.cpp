// Changes of the library: every limit, and what is refused.
#include "common/edits/descriptor/library_change.hpp"

#include <catch2/catch.hpp>
#include <functional>
#include <string>

#include "common/edits/descriptor/edit_descriptor.hpp"
#include "common/edits/descriptor/edit_geometry.hpp"
#include "common/edits/descriptor/edit_memory.hpp"

namespace runstone::test {
namespace {

/// The largest change: all texts, numbers and lists at their bounds.
AddBuild largest_build() {
  AddBuild build;
  build.info.name = std::string(kBuildNameBytesMax, 'n');
  build.info.author = std::string(kBuildAuthorBytesMax, 'a');
  for (char letter = 'a'; letter < 'a' + static_cast<char>(kBuildTagsMax); ++letter)
    build.info.tags.emplace_back(kBuildTagBytesMax, letter);
  build.info.created_us = kBuildTimeMax;
  build.info.sides = {kBuildSideMax, kBuildSideMax, kBuildSideMax};
  build.info.origin = {-kWorldLimit, -kWorldLimit, -kWorldLimit};
  build.touched = build.info.sides.volume();
  build.file_bytes = kLibraryFileBytesMax;
  build.file_digest = ~std::uint64_t{0};
  build.content = ~std::uint64_t{0};
  return build;
}

bool is_refused(const std::function<void(AddBuild&)>& change) {
  AddBuild build = largest_build();
  change(build);
  return !validate(LibraryChange(build)).has_value();
}

}  // namespace

TEST_CASE("changes of the library at the limits are valid, one step beyond they are not",
          "[edits]") {
  CHECK_FALSE(is_refused([](AddBuild&) {}));
  CHECK(is_refused([](AddBuild& b) { b.touched = 0; }));
  CHECK(is_refused([](AddBuild& b) { ++b.touched; }));
  CHECK(is_refused([](AddBuild& b) { b.file_bytes = 0; }));
  CHECK(is_refused([](AddBuild& b) { ++b.file_bytes; }));
  CHECK(is_refused([](AddBuild& b) { b.content = 0; }));
  CHECK(is_refused([](AddBuild& b) { b.info.name += 'n'; }));
  CHECK(is_refused([](AddBuild& b) { b.info.name.clear(); }));
  CHECK(is_refused([](AddBuild& b) { b.info.author += 'a'; }));
  CHECK(is_refused([](AddBuild& b) { b.info.tags.emplace_back("z"); }));
  CHECK(is_refused([](AddBuild& b) { std::swap(b.info.tags[0], b.info.tags[1]); }));
  CHECK(is_refused([](AddBuild& b) { ++b.info.created_us; }));
  CHECK(is_refused([](AddBuild& b) { ++b.info.sides.y; }));
  CHECK(is_refused([](AddBuild& b) { --b.info.origin.z; }));
  CHECK(validate(LibraryChange(RemoveBuild{kSequenceMax})).has_value());
  CHECK_FALSE(validate(LibraryChange(RemoveBuild{0})).has_value());
  CHECK_FALSE(validate(LibraryChange(RemoveBuild{kSequenceMax + 1})).has_value());
}

TEST_CASE("the largest change of the library is within the bound of its kind", "[edits]") {
  const Bytes bytes = encode(library_edit(largest_build()));
  CHECK(bytes.size() <= 3 + kLibraryChangeBytesMax);
  CHECK(bytes.size() + 8 > kLibraryChangeBytesMax);  // the bound is not far off
  const auto decoded = decode_descriptor(bytes);
  REQUIRE(decoded.has_value());
  CHECK(*decoded == library_edit(largest_build()));
}

TEST_CASE("a change of the library has no voxels, no mask and no material", "[edits]") {
  const EditDescriptor edit = library_edit(RemoveBuild{7});
  CHECK_FALSE(has_voxels(edit));
  CHECK(bounding_box(edit).empty());
  CHECK(counted_voxels(edit) == 0);
  CHECK(memory_bytes(edit) > sizeof(EditDescriptor));
  CHECK_FALSE(validate(EditDescriptor{edit.shape, {}, 1}).has_value());
  CHECK_FALSE(validate(EditDescriptor{LibraryEdit{}, {}, kEmpty}).has_value());
}

}  // namespace runstone::test
