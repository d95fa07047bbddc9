// Values of Python that several objects take and give: positions, boxes, materials, arrays, and the
// errors that bad ones raise. Every error here is a ValueError whose text says what was expected.
#pragma once
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <array>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>

#include "common/core/bytes.hpp"
#include "common/core/coords.hpp"
#include "common/core/digest.hpp"
#include "common/core/ids.hpp"
#include "common/core/result.hpp"
#include "common/core/visibility.hpp"
#include "common/runs/run_chunk.hpp"

namespace runstone::python {

namespace py = pybind11;

/// Three whole numbers of Python, such as a position.
using Triple = std::array<std::int64_t, 3>;
/// An array of materials as numpy has it.
using MaterialArray = py::array_t<Material>;

/// A world that cannot be read, or a file that cannot be written. Python knows it as runstone.Error.
struct RunstoneError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The object on which Python calls a method. Unlike a reference, it refuses None and an object whose
/// constructor did not run, with a TypeError. Requires a class that is kept by std::shared_ptr.
template <class T>
class Self {
 public:
  Self() = default;
  explicit Self(std::shared_ptr<T> held) : held_(std::move(held)) {}
  T& operator*() const { return *held_; }
  T* operator->() const { return held_.get(); }
  const std::shared_ptr<T>& pointer() const { return held_; }

 private:
  std::shared_ptr<T> held_;
};

/// Throws a ValueError with this text.
[[noreturn]] void refuse(const std::string& text);
/// Throws a ValueError with the text of an error. `subject` says what was read or checked. The
/// offset is added if it is not 0, with the word that says what it counts.
[[noreturn]] void refuse(const std::string& subject, const Error& error,
                         const char* counted = "byte");

/// Returns the path of a str or an os.PathLike, as the bytes that the file system has. Throws a
/// TypeError for other objects.
std::string path_of(const py::object& path);

/// Returns a position of three numbers, each of them in the range of a world.
VoxelPos position_of(const Triple& at);
/// Returns a whole number. `subject` begins the error if it is none, or has more than 64 bits.
std::int64_t whole_number(const py::handle& number, const std::string& subject);
Material material_of(std::int64_t id);
std::string text_of(const Triple& numbers);
py::tuple tuple_of(VoxelPos at);

/// Returns the word of an axis order, such as "zyx", and back.
const char* word_of(AxisOrder order);
AxisOrder axis_order_of(const std::string& word);
const char* word_of(Visibility visibility);
Visibility visibility_of(const std::string& word);

py::bytes bytes_of(ByteView bytes);
/// Returns the content of a bytes object. The view lives as long as the object.
ByteView view_of(const py::bytes& bytes);

/// An array of materials with three axes x, y, z whose elements lie one after another.
struct VoxelGrid {
  MaterialArray array;  // keeps the elements
  std::array<std::size_t, 3> sides;
  AxisOrder order;  // zyx for C order, xyz for the order of Fortran
  const Material* data() const { return array.data(); }
};

/// Returns the elements of an array of materials. Copies them only if they do not lie one after
/// another. Throws if the type is not uint16 in the byte order of the machine, or there are not
/// three axes.
VoxelGrid voxel_grid(const py::array& array);

/// Makes an array read-only and returns it. Arrays that show the memory of an object are.
py::array read_only(py::array array);

/// Returns an array with the axes x, y, z in C order. The expansion is counted (dense.hpp).
MaterialArray array_of(const RunChunk& chunk);

}  // namespace runstone::python

template <class T>
class pybind11::detail::type_caster<runstone::python::Self<T>> {
  using Held = make_caster<std::shared_ptr<T>>;

 public:
  PYBIND11_TYPE_CASTER(runstone::python::Self<T>, Held::name);

  bool load(handle source, bool convert) {
    if (source.is_none()) return false;
    Held held;
    try {
      if (!held.load(source, convert)) return false;
    } catch (const cast_error&) {
      return false;  // its constructor did not run
    }
    value = runstone::python::Self<T>(cast_op<std::shared_ptr<T>&>(held));
    return true;
  }
};
