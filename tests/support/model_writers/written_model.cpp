#include "tests/support/model_writers/written_model.hpp"

#include <cmath>
#include <cstring>
#include <map>
#include <sstream>
#include <stdexcept>

namespace runstone::test {
namespace {

void model_rule(bool holds, const std::string& rule) {
  if (!holds) throw std::runtime_error(rule);
}

std::istringstream text_of(const Bytes& bytes) {
  return std::istringstream(std::string(bytes.begin(), bytes.end()));
}

struct MtlMaterial {
  std::array<double, 3> colour{};
  double alpha = 1;
};

std::map<std::string, MtlMaterial> read_mtl(const Bytes& mtl) {
  std::map<std::string, MtlMaterial> out;
  std::istringstream text = text_of(mtl);
  std::string line;
  MtlMaterial* current = nullptr;
  while (std::getline(text, line)) {
    std::istringstream words(line);
    std::string key;
    words >> key;
    if (key == "newmtl") {
      std::string name, more;
      words >> name;
      model_rule(!(words >> more), "mtl: a name with a blank");
      model_rule(out.count(name) == 0, "mtl: two materials have one name");
      current = &out[name];
    } else if (key == "Kd") {
      for (double& share : current->colour) words >> share;
      model_rule(!words.fail(), "mtl: Kd");
    } else if (key == "d") {
      words >> current->alpha;
      model_rule(!words.fail(), "mtl: d");
    }
  }
  return out;
}

std::string colour_text(const std::array<double, 4>& shares) {
  std::string out;
  for (const double share : shares)
    out += (out.empty() ? "" : " ") + std::to_string(std::lround(share * 255));
  return out;
}

template <class T>
T ply_value(const Bytes& bytes, std::size_t& at) {
  model_rule(at + sizeof(T) <= bytes.size(), "ply: the file ends early");
  T v;
  std::memcpy(&v, bytes.data() + at, sizeof v);
  at += sizeof v;
  return v;
}

}  // namespace

WrittenModel read_written_obj(const Bytes& obj, const Bytes& mtl) {
  WrittenModel out;
  const auto materials = read_mtl(mtl);
  for (const auto& [name, material] : materials) out.material_names.push_back(name);
  std::vector<ModelPlace> places, normals;
  std::string line;
  std::istringstream text = text_of(obj);
  const MtlMaterial* current = nullptr;
  bool has_library = false;
  while (std::getline(text, line)) {
    std::istringstream words(line);
    std::string key;
    words >> key;
    if (key == "mtllib") has_library = true;
    if (key == "v" || key == "vn") {
      ModelPlace place;
      for (double& v : place) words >> v;
      model_rule(!words.fail(), "obj: " + line);
      (key == "v" ? places : normals).push_back(place);
    } else if (key == "usemtl") {
      std::string name;
      words >> name;
      model_rule(has_library && materials.count(name) != 0, "obj: no material " + name);
      current = &materials.at(name);
    } else if (key == "f") {
      model_rule(current != nullptr, "obj: a face without a material");
      WrittenTriangle triangle;
      const auto& c = current->colour;
      triangle.colour = colour_text({c[0], c[1], c[2], current->alpha});
      for (std::size_t k = 0; k < 3; ++k) {
        std::size_t vertex = 0, normal = 0;
        char slash = 0, other = 0;
        words >> vertex >> slash >> other >> normal;
        model_rule(!words.fail() && slash == '/' && other == '/', "obj: " + line);
        model_rule(vertex >= 1 && vertex <= places.size(), "obj: no vertex: " + line);
        model_rule(normal >= 1 && normal <= normals.size(), "obj: no normal: " + line);
        triangle.vertices[k] = vertex;
        triangle.places[k] = places[vertex - 1];
        triangle.normal = normals[normal - 1];
      }
      model_rule(!(words >> key), "obj: a face of more than three corners");
      out.triangles.push_back(triangle);
    }
  }
  out.vertex_count = places.size();
  return out;
}

WrittenModel read_written_ply(const Bytes& file) {
  std::istringstream text = text_of(file);
  std::string line;
  std::size_t vertices = 0, faces = 0;
  std::vector<std::string> properties;
  model_rule(std::getline(text, line) && line == "ply", "ply: magic");
  model_rule(std::getline(text, line) && line == "format binary_little_endian 1.0", "ply: format");
  while (std::getline(text, line) && line != "end_header") {
    std::istringstream words(line);
    std::string key, name;
    words >> key;
    if (key == "element") {
      words >> name;
      words >> (name == "vertex" ? vertices : faces);
    } else if (key == "property") {
      properties.push_back(line);
    }
  }
  const std::vector<std::string> expected = {"property float x",
                                             "property float y",
                                             "property float z",
                                             "property float nx",
                                             "property float ny",
                                             "property float nz",
                                             "property uchar red",
                                             "property uchar green",
                                             "property uchar blue",
                                             "property uchar alpha",
                                             "property list uchar int vertex_indices"};
  model_rule(properties == expected, "ply: properties");
  auto at = static_cast<std::size_t>(text.tellg());
  struct PlyVertex {
    ModelPlace place, normal;
    std::string colour;
  };
  std::vector<PlyVertex> list(vertices);
  for (PlyVertex& vertex : list) {
    for (double& v : vertex.place) v = ply_value<float>(file, at);
    for (double& v : vertex.normal) v = ply_value<float>(file, at);
    // The axis z of the file points up.
    for (ModelPlace* v : {&vertex.place, &vertex.normal}) *v = {(*v)[0], (*v)[2], -(*v)[1]};
    for (int i = 0; i < 4; ++i)
      vertex.colour += (i == 0 ? "" : " ") + std::to_string(ply_value<std::uint8_t>(file, at));
  }
  WrittenModel out;
  out.vertex_count = vertices;
  for (std::size_t i = 0; i < faces; ++i) {
    model_rule(ply_value<std::uint8_t>(file, at) == 3, "ply: a face is no triangle");
    WrittenTriangle triangle;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto vertex = static_cast<std::size_t>(ply_value<std::int32_t>(file, at));
      model_rule(vertex < vertices, "ply: no vertex");
      triangle.vertices[k] = vertex;
      triangle.places[k] = list[vertex].place;
      if (k != 0) model_rule(triangle.normal == list[vertex].normal, "ply: normals differ");
      if (k != 0) model_rule(triangle.colour == list[vertex].colour, "ply: colours differ");
      triangle.normal = list[vertex].normal;
      triangle.colour = list[vertex].colour;
    }
    out.triangles.push_back(triangle);
  }
  model_rule(at == file.size(), "ply: bytes follow");
  return out;
}

}  // namespace runstone::test
