#include "common/build_files/model_words.hpp"

#include <catch2/catch.hpp>

namespace runstone::test {
namespace {

std::string refusal_of(std::string_view name, std::string_view value) {
  const ModelWord* const word = model_word(name);
  REQUIRE(word != nullptr);
  ModelChoices choices;
  const auto chosen = choose_by_word(*word, value, choices);
  if (!chosen) CHECK(choices == ModelChoices());
  return chosen ? "" : chosen.error();
}

ModelChoices chosen_with(
    std::initializer_list<std::pair<std::string_view, std::string_view>> words) {
  ModelChoices out;
  for (const auto& [name, value] : words) {
    const ModelWord* const word = model_word(name);
    REQUIRE(word != nullptr);
    REQUIRE(word->has_value() == !value.empty());
    REQUIRE(choose_by_word(*word, value, out).has_value());
  }
  return out;
}

}  // namespace

TEST_CASE("words choose how a model becomes voxels", "[build_files]") {
  const ModelChoices choices = chosen_with({{"voxels", "4096"},
                                            {"surface", "thick"},
                                            {"hollow", ""},
                                            {"fill-overlaps", ""},
                                            {"up", "z"},
                                            {"turn", "270"}});
  CHECK(choices.voxels == 4096);
  CHECK(choices.surface == SurfaceMode::separating_26);
  CHECK_FALSE(choices.is_solid);
  CHECK(choices.fills_overlaps);
  CHECK(choices.up == ModelUp::z);
  CHECK(choices.quarters == 3);
  CHECK(model_word("colour") == nullptr);
}

TEST_CASE("of two sizes of a model the last one counts", "[build_files]") {
  CHECK(chosen_with({{"voxels", "7"}, {"voxels-per-metre", "0.5"}}).voxels_per_metre == 0.5);
  const ModelChoices choices = chosen_with({{"voxels-per-metre", "0.5"}, {"voxels", "7"}});
  CHECK(choices.voxels == 7);
  CHECK_FALSE(choices.voxels_per_metre);
}

TEST_CASE("values out of range are refused with what is expected", "[build_files]") {
  for (const char* value : {"0", "4097", "-1", "1.5", "", "many", "99999999999999999999"}) {
    CAPTURE(value);
    CHECK(refusal_of("voxels", value) == "a whole number from 1 to 4096 is expected");
  }
  for (const char* value : {"0", "-2", "2000000", "nan", "inf", "1e", ""}) {
    CAPTURE(value);
    CHECK(refusal_of("voxels-per-metre", value) == "a number from 0.000001 to 1000000 is expected");
  }
  CHECK(refusal_of("surface", "hard") == "none, thin, thick or all is expected");
  CHECK(refusal_of("up", "x") == "y or z is expected");
  CHECK(refusal_of("turn", "45") == "0, 90, 180 or 270 is expected");
}

TEST_CASE("a model needs an inside or a surface", "[build_files]") {
  CHECK(choices_refusal(chosen_with({{"surface", "none"}})).empty());
  CHECK(choices_refusal(chosen_with({{"hollow", ""}})).empty());
  CHECK(choices_refusal(chosen_with({{"hollow", ""}, {"surface", "none"}})) ==
        "neither its inside nor its surface is wanted");
}

}  // namespace runstone::test
