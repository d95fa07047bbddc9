#include "common/models/model_format.hpp"

#include <catch2/catch.hpp>

using namespace runstone;

TEST_CASE("the ending of a name says the format of a model", "[models]") {
  CHECK(model_format_of("statue.obj") == ModelFormat::obj);
  CHECK(model_format_of("/home/ada/STATUE.STL") == ModelFormat::stl);
  CHECK(model_format_of("a.b.Ply") == ModelFormat::ply);
  CHECK(model_format_of("town.gltf") == ModelFormat::gltf);
  CHECK(model_format_of("town.glb") == ModelFormat::glb);
  CHECK_FALSE(model_format_of("town.fbx").has_value());
  CHECK_FALSE(model_format_of(".obj").has_value());
  CHECK_FALSE(model_format_of("obj").has_value());
  CHECK_FALSE(model_format_of("").has_value());
}

TEST_CASE("scans and prints have z up, scenes have y up", "[models]") {
  CHECK(usual_up(ModelFormat::stl) == ModelUp::z);
  CHECK(usual_up(ModelFormat::ply) == ModelUp::z);
  CHECK(usual_up(ModelFormat::obj) == ModelUp::y);
  CHECK(usual_up(ModelFormat::gltf) == ModelUp::y);
  CHECK(usual_up(ModelFormat::glb) == ModelUp::y);
}
