// The library as the world strand knows it: what is counted, and which limit refuses a build.
#include "server/world/order/library.hpp"

#include <catch2/catch.hpp>
#include <string>
#include <vector>

namespace runstone::test {
namespace {

constexpr LibraryLimits kSmallLibrary{4, 10U << 20, 4U << 20, 2, 5U << 20};

EditRecord library_record_of(Sequence seq, AuthorId author, LibraryChange change) {
  EditRecord record;
  record.version = {1, seq};
  record.op = {author, 7, seq};
  record.cause = Cause::library;
  record.edit = library_edit(std::move(change));
  return record;
}

EditRecord added_build(Sequence seq, AuthorId author, std::uint64_t file_bytes) {
  AddBuild build;
  build.info.name = "b" + std::to_string(seq);
  build.file_bytes = file_bytes;
  build.content = seq;
  return library_record_of(seq, author, build);
}

}  // namespace

TEST_CASE("the library counts builds as records add and remove them", "[library]") {
  const std::vector<LibraryRow> rows = {{3, 1, 100}, {5, 0, 50}};
  Library library(kSmallLibrary, rows);
  CHECK(library.total() == LibraryTotal{2, 150});
  CHECK(library.total_of(1) == LibraryTotal{1, 100});
  CHECK(library.total_of(2) == LibraryTotal{});
  CHECK(library.newest() == 0);
  library.apply(std::vector{added_build(9, 1, 30), library_record_of(10, 2, RemoveBuild{3}),
                            library_record_of(11, 2, RemoveBuild{3}),
                            library_record_of(12, 2, RemoveBuild{700})});
  CHECK(library.newest() == 12);
  CHECK(library.total() == LibraryTotal{2, 80});
  CHECK(library.total_of(1) == LibraryTotal{1, 30});
  CHECK(library.find(3) == nullptr);
  REQUIRE(library.find(9) != nullptr);
  CHECK(*library.find(9) == LibraryRow{9, 1, 30});
  // A server that follows may have read the row already.
  library.apply(std::vector{added_build(9, 1, 30)});
  CHECK(library.total() == LibraryTotal{2, 80});
}

TEST_CASE("each limit of the library refuses with its name, its value and what to do",
          "[library]") {
  constexpr std::uint64_t kMib = 1U << 20;
  Library library(kSmallLibrary, {});
  CHECK_FALSE(library.refusal(1, 4 * kMib));
  CHECK(*library.refusal(1, 4 * kMib + 1) ==
        "the build takes 5 MiB, and one of at most 4 MiB is allowed (build_mib): divide it");
  library.apply(std::vector{added_build(1, 1, 3 * kMib)});
  CHECK(*library.refusal(1, 3 * kMib) ==
        "the builds of the player take 3 MiB, and at most 5 MiB are allowed "
        "(builds_mib_per_player): remove some");
  CHECK_FALSE(library.refusal(2, 3 * kMib));
  CHECK_FALSE(library.refusal(0, 3 * kMib));
  library.apply(std::vector{added_build(2, 1, 1)});
  CHECK(*library.refusal(1, 1) ==
        "the player has 2 builds in the library, and no more are allowed (builds_per_player): "
        "remove some");
  library.apply(std::vector{added_build(3, 0, 4 * kMib)});
  CHECK(*library.refusal(0, 4 * kMib) ==
        "the library of this world takes 8 MiB, and at most 10 MiB are allowed (builds_mib): "
        "remove some builds");
  library.apply(std::vector{added_build(4, 0, 1)});
  CHECK(*library.refusal(0, 1) ==
        "the library of this world has 4 builds, and no more are allowed (builds_max): remove "
        "some");
}

TEST_CASE("content numbers differ within a start and between starts", "[library]") {
  Library library(kSmallLibrary, {}), next(kSmallLibrary, {});
  const std::uint64_t first = library.next_content(1), second = library.next_content(1);
  CHECK(first != 0);
  CHECK(first != second);
  CHECK(next.next_content(2) > second);
}

}  // namespace runstone::test
