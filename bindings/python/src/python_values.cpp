#include "python_values.hpp"

#include <algorithm>
#include <string_view>
#include <utility>

#include "common/runs/dense.hpp"
#include "common/runs/reorder.hpp"

namespace runstone::python {
namespace {

constexpr std::array<const char*, kAxisOrderCount> kOrderWords = {"xyz", "xzy", "yxz",
                                                                  "yzx", "zxy", "zyx"};
constexpr std::array<const char*, 3> kVisibilityWords = {"empty", "opaque", "transparent"};

bool is_aligned(const py::array& array) {
  return (array.flags() & py::detail::npy_api::NPY_ARRAY_ALIGNED_) != 0;
}

}  // namespace

void refuse(const std::string& text) { throw py::value_error(text); }

void refuse(const std::string& subject, const Error& error, const char* counted) {
  std::string text = subject + ": " + error.what;
  if (error.offset != 0)
    text += std::string(" (") + counted + " " + std::to_string(error.offset) + ")";
  throw py::value_error(text);
}

std::string path_of(const py::object& path) {
  return py::module_::import("os").attr("fsencode")(path).cast<std::string>();
}

VoxelPos position_of(const Triple& at) {
  for (const std::int64_t number : at) {
    if (number < -kWorldLimit || number >= kWorldLimit) {
      refuse("the position " + text_of(at) + " is outside the world: coordinates are " +
             std::to_string(-kWorldLimit) + " to " + std::to_string(kWorldLimit - 1));
    }
  }
  return {static_cast<std::int32_t>(at[0]), static_cast<std::int32_t>(at[1]),
          static_cast<std::int32_t>(at[2])};
}

std::int64_t whole_number(const py::handle& number, const std::string& subject) {
  try {
    return number.cast<std::int64_t>();
  } catch (const py::cast_error&) {
    refuse(subject + " is no whole number of 64 bits: " + std::string(py::repr(number)));
  }
}

Material material_of(std::int64_t id) {
  if (id < 0 || id >= static_cast<std::int64_t>(kMaterialCountMax))
    refuse("a material is a number from 0 to 65535, got " + std::to_string(id));
  return static_cast<Material>(id);
}

std::string text_of(const Triple& numbers) {
  return "(" + std::to_string(numbers[0]) + ", " + std::to_string(numbers[1]) + ", " +
         std::to_string(numbers[2]) + ")";
}

py::tuple tuple_of(VoxelPos at) { return py::make_tuple(at.x, at.y, at.z); }

const char* word_of(AxisOrder order) { return kOrderWords[static_cast<std::size_t>(order)]; }

AxisOrder axis_order_of(const std::string& word) {
  const auto found = std::find(kOrderWords.begin(), kOrderWords.end(), std::string_view(word));
  if (found == kOrderWords.end())
    refuse("an axis order is one of xyz, xzy, yxz, yzx, zxy and zyx, got \"" + word + "\"");
  return static_cast<AxisOrder>(found - kOrderWords.begin());
}

const char* word_of(Visibility visibility) {
  return kVisibilityWords[static_cast<std::size_t>(visibility)];
}

Visibility visibility_of(const std::string& word) {
  const auto found =
      std::find(kVisibilityWords.begin(), kVisibilityWords.end(), std::string_view(word));
  if (found == kVisibilityWords.end())
    refuse("a visibility is \"empty\", \"opaque\" or \"transparent\", got \"" + word + "\"");
  return static_cast<Visibility>(found - kVisibilityWords.begin());
}

py::bytes bytes_of(ByteView bytes) {
  return py::bytes(reinterpret_cast<const char*>(bytes.data()), bytes.size());
}

ByteView view_of(const py::bytes& bytes) {
  const std::string_view text = bytes;
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

VoxelGrid voxel_grid(const py::array& array) {
  if (!py::isinstance<MaterialArray>(array)) {
    refuse("an array of materials has the dtype uint16, got " +
           std::string(py::str(array.dtype())) + "; array.astype(numpy.uint16) converts it");
  }
  if (array.ndim() != 3) {
    refuse("an array of voxels has the three axes x, y, z, got " + std::to_string(array.ndim()) +
           (array.ndim() == 1 ? " axis" : " axes"));
  }
  const bool is_c = (array.flags() & py::array::c_style) != 0;
  const bool is_fortran = (array.flags() & py::array::f_style) != 0;
  const bool is_plain = is_aligned(array) && (is_c || is_fortran);
  const auto plain =
      py::reinterpret_borrow<MaterialArray>(is_plain ? py::object(array) : array.attr("copy")("C"));
  const auto side = [&](py::ssize_t axis) { return static_cast<std::size_t>(array.shape(axis)); };
  return {plain, {side(0), side(1), side(2)}, is_plain && !is_c ? AxisOrder::xyz : AxisOrder::zyx};
}

py::array read_only(py::array array) {
  array.attr("setflags")(py::arg("write") = false);
  return array;
}

MaterialArray array_of(const RunChunk& chunk) {
  count_dense_expansion();
  const auto sides = chunk.extent.sides();
  MaterialArray array({sides[0], sides[1], sides[2]});
  Material* const out = array.mutable_data();
  const auto write = [out](const RunChunk& lines) {
    std::uint32_t begin = 0;
    for (std::size_t i = 0; i < lines.runs.size(); ++i) {
      const Run run = lines.runs[i];
      std::fill(out + begin, out + run.end, run.material);
      begin = run.end;
    }
  };
  if (chunk.order == AxisOrder::zyx || chunk.is_uniform()) {
    write(chunk);
  } else {
    write(reorder(chunk, AxisOrder::zyx));
  }
  return array;
}

}  // namespace runstone::python
