#include "python_world.hpp"

#include <limits>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "common/core/hex.hpp"
#include "common/edits/descriptor/edit_geometry.hpp"
#include "common/edits/descriptor/edit_kind_name.hpp"
#include "open_world_view.hpp"
#include "python_chunk.hpp"
#include "python_edit.hpp"

namespace runstone::python {
namespace {

using WorldObject = std::shared_ptr<OpenWorldView>;

/// The elements of one array of a world: 16 GiB.
constexpr std::uint64_t kArrayVoxelsMax = std::uint64_t{1} << 33;

/// Calls f without Python's lock and returns its value. Throws the error as Python knows it.
template <class F>
auto read_world(F&& f) {
  auto result = [&] {
    const py::gil_scoped_release released;
    return f();
  }();
  if (!result) {
    const ViewError& error = result.error();
    if (error.kind == ViewError::Kind::unreadable) throw RunstoneError(error.text);
    refuse(error.text);
  }
  if constexpr (!std::is_same_v<decltype(result), ViewResult<void>>) return *std::move(result);
}

const char* word_of(Cause cause) {
  switch (cause) {
    case Cause::player:
      return "player";
    case Cause::console:
      return "console";
    case Cause::rollback:
      return "rollback";
    case Cause::undo:
      return "undo";
    case Cause::redo:
      return "redo";
    case Cause::import:
      return "import";
    case Cause::rights:
      return "rights";
    case Cause::materials:
      return "materials";
    case Cause::library:
      return "library";
    case Cause::clock:
      return "clock";
    case Cause::textures:
      return "textures";
    case Cause::gap:
      return "gap";
  }
  return "unknown";
}

py::object datetime_of(TimeUs us) {
  const py::module_ datetime = py::module_::import("datetime");
  const py::object epoch = datetime.attr("datetime")(
      1970, 1, 1, py::arg("tzinfo") = datetime.attr("timezone").attr("utc"));
  return epoch + datetime.attr("timedelta")(py::arg("microseconds") = us);
}

/// Returns the microseconds since 1970 of a datetime with a time zone.
TimeUs time_of(const py::object& time) {
  const py::module_ datetime = py::module_::import("datetime");
  if (time.attr("tzinfo").is_none()) {
    refuse("the moment " + std::string(py::str(time)) +
           " has no time zone: give it one, such as tzinfo=datetime.timezone.utc");
  }
  const py::object since = time - datetime_of(0);
  return (since.attr("__floordiv__")(datetime.attr("timedelta")(py::arg("microseconds") = 1)))
      .cast<TimeUs>();
}

NamedMoment moment_of(const py::object& moment) {
  if (py::isinstance<py::str>(moment)) {
    const auto parsed = parse_moment(moment.cast<std::string>());
    if (!parsed) refuse(parsed.error());
    return *parsed;
  }
  if (py::isinstance(moment, py::module_::import("datetime").attr("datetime")))
    return AtTime{time_of(moment)};
  if (py::hasattr(moment, "__index__")) {
    const std::int64_t sequence = whole_number(moment, "the sequence");
    if (sequence < 0) refuse("a sequence is 0 or greater, got " + std::to_string(sequence));
    return static_cast<Sequence>(sequence);
  }
  refuse(
      "a moment is a sequence number, a datetime with a time zone, or a text such as "
      "\"2026-11-21T23:05:00Z\" or \"-2h30m\", got " +
      std::string(py::repr(moment)));
}

/// One axis of an index: the voxels [first, last), and whether the axis stays in the array.
struct AxisIndex {
  std::int64_t first = 0, last = 0;
  bool is_range = true;
};

AxisIndex axis_index(const py::handle& index, char axis) {
  const auto wrong = [&](const std::string& what) {
    refuse(std::string("the index of the axis ") + axis + " " + what);
  };
  AxisIndex out;
  if (py::isinstance<py::slice>(index)) {
    const py::object start = index.attr("start"), stop = index.attr("stop"),
                     step = index.attr("step");
    if (start.is_none() || stop.is_none())
      wrong("needs both ends, such as 0:256, because a world has no edges");
    if (!step.is_none() && whole_number(step, "a step") != 1)
      wrong("has a step; take steps in the array");
    out.first = whole_number(start, "the first end of a slice");
    out.last = whole_number(stop, "the second end of a slice");
    if (out.last <= out.first) wrong("is empty: the second end must be greater than the first one");
  } else if (py::hasattr(index, "__index__")) {
    out.first = whole_number(index, "an index");
    out.last = out.first == std::numeric_limits<std::int64_t>::max() ? out.first : out.first + 1;
    out.is_range = false;
  } else {
    wrong("is neither a slice nor a number");
  }
  if (out.first < -kWorldLimit || out.last > kWorldLimit) wrong("is outside the world");
  return out;
}

py::object world_voxels(const Self<OpenWorldView>& self, const py::object& index) {
  if (!py::isinstance<py::tuple>(index) || py::len(index) != 3)
    refuse("a world is read by three indices, such as world[0:256, 0:256, 0:256]");
  const py::tuple parts = index;
  std::array<AxisIndex, 3> axes;
  std::array<py::ssize_t, 3> sides{};
  std::uint64_t volume = 1;
  for (std::size_t i = 0; i < 3; ++i) {
    axes[i] = axis_index(parts[i], static_cast<char>('x' + i));
    sides[i] = static_cast<py::ssize_t>(axes[i].last - axes[i].first);
    // Each side is below 2^31, and the product so far at most 2^33.
    volume *= static_cast<std::uint64_t>(sides[i]);
    if (volume > kArrayVoxelsMax)
      refuse("the box has more than 8589934592 voxels: read it in parts");
  }
  const auto corner = [&](auto end) {
    return VoxelPos{static_cast<std::int32_t>(axes[0].*end),
                    static_cast<std::int32_t>(axes[1].*end),
                    static_cast<std::int32_t>(axes[2].*end)};
  };
  const VoxelBox box{corner(&AxisIndex::first), corner(&AxisIndex::last)};
  MaterialArray array(sides);
  const std::span<Material> out(array.mutable_data(), volume);
  read_world([&] { return self->voxels(box, out); });
  py::tuple rest(3);
  for (std::size_t i = 0; i < 3; ++i)
    rest[i] = axes[i].is_range ? py::object(py::slice(py::none(), py::none(), py::none()))
                               : py::object(py::int_(0));
  return array.attr("__getitem__")(rest);
}

std::shared_ptr<PythonChunk> world_chunk(const Self<OpenWorldView>& self, const Triple& key) {
  const std::int64_t edge = self->meta().chunk_edge;
  for (const std::int64_t number : key) {
    if (number < -kWorldLimit / edge || number >= kWorldLimit / edge)
      refuse("the chunk " + text_of(key) + " is outside the world");
  }
  const ChunkCoord at{static_cast<std::int32_t>(key[0]), static_cast<std::int32_t>(key[1]),
                      static_cast<std::int32_t>(key[2])};
  Chunk chunk = read_world([&] { return self->chunk(at); });
  return std::make_shared<PythonChunk>(PythonChunk{std::move(chunk.voxels), chunk.digest});
}

std::vector<PythonMaterial> world_materials(const Self<OpenWorldView>& self) {
  const MaterialTable table = read_world([&] { return self->materials(); });
  std::vector<PythonMaterial> out;
  for (const MaterialInfo& row : table.rows())
    out.push_back({static_cast<std::int64_t>(out.size()), row.name, row.colour, row.visibility});
  return out;
}

py::array world_visibility(const Self<OpenWorldView>& self) {
  const MaterialTable table = read_world([&] { return self->materials(); });
  const std::vector<Visibility> rows = visibilities(table);
  py::array_t<std::uint8_t> out(static_cast<py::ssize_t>(rows.size()));
  for (std::size_t i = 0; i < rows.size(); ++i)
    out.mutable_data()[i] = static_cast<std::uint8_t>(rows[i]);
  return out;
}

py::dict world_players(const Self<OpenWorldView>& self) {
  py::dict out;
  for (const PlayerRow& row : read_world([&] { return self->players(); }))
    out[py::int_(row.author)] = row.name;
  return out;
}

/// A record of the log as an object of Python.
struct PythonRecord {
  EditRecord record;
};

/// Walks over the log in blocks of records. Threads: any; each record is given once.
class PythonLog {
 public:
  PythonLog(WorldObject world, Sequence first, Sequence last)
      : world_(std::move(world)), next_(first), last_(last) {}

  PythonRecord next() {
    auto record = read_world([&] { return read_next(); });
    if (!record) throw py::stop_iteration();
    return {*std::move(record)};
  }

 private:
  /// Returns the next record, or nullopt behind the last one. Must be called without Python's lock,
  /// which another thread that has mutex_ may wait for.
  ViewResult<std::optional<EditRecord>> read_next() {
    const std::lock_guard lock(mutex_);
    if (const auto open = world_->require_open(); !open) return failure(open.error());
    if (at_ == block_.size()) {
      if (next_ > last_) return std::nullopt;
      auto block = world_->records(next_, last_, kBlockRecords);
      if (!block) return failure(block.error());
      block_ = *std::move(block);
      at_ = 0;
      if (block_.empty()) return std::nullopt;
      next_ = block_.back().version.seq + 1;
    }
    return block_[at_++];
  }

  static constexpr std::size_t kBlockRecords = 256;
  const WorldObject world_;
  std::mutex mutex_;
  Sequence next_;
  const Sequence last_;
  std::vector<EditRecord> block_;
  std::size_t at_ = 0;  // in block_
};

std::shared_ptr<PythonLog> world_log(const Self<OpenWorldView>& self, std::int64_t first,
                                     std::optional<std::int64_t> last) {
  if (first < 1) refuse("the first sequence is 1, got " + std::to_string(first));
  if (last && *last < 0) refuse("a sequence is 0 or greater, got " + std::to_string(*last));
  const LogEnd end = read_world([&] { return self->end(); });
  const Sequence until =
      last ? std::min(static_cast<Sequence>(*last), end.version.seq) : end.version.seq;
  return std::make_shared<PythonLog>(self.pointer(), static_cast<Sequence>(first), until);
}

void define_material(py::module_& module) {
  py::class_<PythonMaterial, std::shared_ptr<PythonMaterial>>(
      module, "Material", "A material: a row of a material table.")
      .def(py::init([](std::int64_t id, std::string name, const std::vector<std::int64_t>& colour,
                       const std::string& visibility) {
             PythonMaterial out{material_of(id), std::move(name), {}, visibility_of(visibility)};
             if (colour.size() != 3 && colour.size() != 4)
               refuse("a colour has 3 or 4 numbers: red, green, blue, alpha");
             out.colour[3] = 255;
             for (std::size_t i = 0; i < colour.size(); ++i) {
               if (colour[i] < 0 || colour[i] > 255)
                 refuse("a colour has numbers from 0 to 255, got " + std::to_string(colour[i]));
               out.colour[i] = static_cast<std::uint8_t>(colour[i]);
             }
             const auto valid = validate_material(out.name, out.colour, out.visibility,
                                                  MaterialBody::solid, std::nullopt);
             if (!valid) refuse("material", valid.error());
             return out;
           }),
           py::arg("id"), py::arg("name"), py::arg("colour"), py::arg("visibility") = "opaque",
           "Make a material for write_build(). The colour is sRGB with or without alpha, 0 to 255.")
      .def_property_readonly(
          "id", [](const Self<PythonMaterial>& self) { return self->id; },
          "The number that voxels have, 0 to 65535.")
      .def_property_readonly(
          "name", [](const Self<PythonMaterial>& self) { return self->name; },
          "The name, unique in a material table.")
      .def_property_readonly(
          "colour",
          [](const Self<PythonMaterial>& self) {
            const MaterialColour& c = self->colour;
            return py::make_tuple(c[0], c[1], c[2], c[3]);
          },
          "Red, green, blue and alpha, 0 to 255.")
      .def_property_readonly(
          "visibility",
          [](const Self<PythonMaterial>& self) { return python::word_of(self->visibility); },
          "\"empty\", \"opaque\" or \"transparent\".")
      .def("__repr__", [](const Self<PythonMaterial>& self) {
        return "<runstone.Material " + std::to_string(self->id) + " \"" + self->name + "\">";
      });
}

void define_log(py::module_& module) {
  py::class_<PythonRecord, std::shared_ptr<PythonRecord>>(module, "LogRecord",
                                                          "A record of a world's log.")
      .def_property_readonly(
          "sequence", [](const Self<PythonRecord>& self) { return self->record.version.seq; },
          "The place in the log, from 1, without gaps.")
      .def_property_readonly(
          "epoch", [](const Self<PythonRecord>& self) { return self->record.version.epoch; },
          "The number of the server's start.")
      .def_property_readonly(
          "time", [](const Self<PythonRecord>& self) { return datetime_of(self->record.time_us); },
          "The time as a datetime in UTC.")
      .def_property_readonly(
          "time_us", [](const Self<PythonRecord>& self) { return self->record.time_us; },
          "The time in microseconds since 1970, UTC.")
      .def_property_readonly(
          "author", [](const Self<PythonRecord>& self) { return self->record.op.author; },
          "The number of the player, a key of World.players. 0 is the server.")
      .def_property_readonly(
          "cause", [](const Self<PythonRecord>& self) { return word_of(self->record.cause); },
          "Why the record is in the log: player, console, rollback, undo, redo, import, rights, "
          "materials, library, clock, textures or gap.")
      .def_property_readonly(
          "kind",
          [](const Self<PythonRecord>& self) { return name_of(kind_of(self->record.edit)); },
          "The kind of the edit: voxel, box, sphere, stroke or paste, or a kind without voxels.")
      .def_property_readonly(
          "box",
          [](const Self<PythonRecord>& self) {
            return box_object(bounding_box(self->record.edit));
          },
          "The smallest box that holds the edit, as ((x, y, z), (x, y, z)), or None. The second "
          "corner is not in the box.")
      .def_property_readonly(
          "edit", [](const Self<PythonRecord>& self) { return object_of(self->record.edit); },
          "The edit. Chunk.apply() takes it.")
      .def_property_readonly(
          "subject", [](const Self<PythonRecord>& self) { return self->record.subject; },
          "The record that this one takes back or makes again, or the first record of its action. "
          "0 if there is none.")
      .def("__repr__", [](const Self<PythonRecord>& self) {
        return "<runstone.LogRecord " + std::to_string(self->record.version.seq) + ": " +
               name_of(kind_of(self->record.edit)) + " by " +
               std::to_string(self->record.op.author) + ">";
      });
  py::class_<PythonLog, std::shared_ptr<PythonLog>>(module, "Log",
                                                    "An iterator over records of a log, in order.")
      .def("__iter__", [](py::object self) { return self; })
      .def("__next__", [](const Self<PythonLog>& self) { return self->next(); });
}

}  // namespace

void define_world(py::module_& module) {
  define_material(module);
  define_log(module);
  py::class_<OpenWorldView, WorldObject>(
      module, "World",
      "A world on disk, open for reading. A server may be running it.\n\n"
      "open() gives a world that follows its log: every read first takes in what was written to "
      "disk meanwhile. at() gives the world of one moment, which does not change.\n"
      "Threads may share a world; their calls wait for each other. After close() every call raises "
      "ValueError.")
      .def_static(
          "open",
          [](const py::object& path) {
            const std::string place = path_of(path);
            return read_world([&] { return OpenWorldView::open(place, std::nullopt); });
          },
          py::arg("place"),
          "Open the world at a place: a folder, or the address of a PostgreSQL database.\n\n"
          "Raise Error if there is no world or it cannot be read.")
      .def(
          "at",
          [](const Self<OpenWorldView>& self, const py::object& moment) {
            const NamedMoment at = moment_of(moment);
            return read_world([&] { return self->at(at); });
          },
          py::arg("moment"),
          "Return the world of a moment, as a world of its own.\n\n"
          "moment is a sequence number (the world after this edit, 0 before the first one), a "
          "datetime with a time zone, or a text as runstone-replay takes it: "
          "\"2026-11-21T23:05:00Z\", \"-2h30m\".\n"
          "Raise ValueError if the log does not have the moment.")
      .def(
          "close",
          [](const Self<OpenWorldView>& self) {
            const py::gil_scoped_release released;
            self->close();
          },
          "Close the world. Closing it twice does nothing.")
      .def_property_readonly(
          "closed",
          [](const Self<OpenWorldView>& self) {
            const py::gil_scoped_release released;
            return self->is_closed();
          },
          "True after close().")
      .def("__enter__", [](py::object self) { return self; })
      .def("__exit__",
           [](const Self<OpenWorldView>& self, const py::args&) {
             const py::gil_scoped_release released;
             self->close();
           })
      .def("__getitem__", &world_voxels, py::arg("box"),
           "Return the voxels of a box as an array of uint16 with the axes x, y, z.\n\n"
           "world[x0:x1, y0:y1, z0:z1] has the voxels from x0 to x1 - 1 and so on. Coordinates are "
           "those of the world, so negative ones do not count from an end. A number in the place "
           "of a slice removes the axis.")
      .def("chunk", &world_chunk, py::arg("key"),
           "Return the chunk at the place (x, y, z) of the grid of chunks.")
      .def("log", &world_log, py::arg("first") = 1, py::arg("last") = py::none(),
           "Return an iterator over the records of the log from first to last, both included.\n\n"
           "Without last it ends where the log ended when log() was called. Records that a "
           "compaction took out of the log are left out.")
      .def_property_readonly(
          "sequence",
          [](const Self<OpenWorldView>& self) {
            return read_world([&] { return self->end(); }).version.seq;
          },
          "The sequence of the last edit that the world shows, 0 before the first one.")
      .def_property_readonly(
          "time",
          [](const Self<OpenWorldView>& self) -> py::object {
            const LogEnd end = read_world([&] { return self->end(); });
            return end.version.seq == 0 ? py::none() : datetime_of(end.time_us);
          },
          "The time of that edit as a datetime in UTC, or None before the first one.")
      .def_property_readonly(
          "pinned", [](const Self<OpenWorldView>& self) { return self->is_pinned(); },
          "True for the world of a moment, which at() gives.")
      .def_property_readonly(
          "place", [](const Self<OpenWorldView>& self) { return place_name(self->place()); },
          "The place that was opened. An address of a database is shown without its password.")
      .def_property_readonly(
          "edge", [](const Self<OpenWorldView>& self) { return self->meta().chunk_edge; },
          "The edge of the chunks: 16, 32, 64 or 128 voxels.")
      .def_property_readonly(
          "world_id", [](const Self<OpenWorldView>& self) { return to_hex(self->meta().world_id); },
          "The identity of the world as 32 hexadecimal digits.")
      .def_property_readonly(
          "generator", [](const Self<OpenWorldView>& self) { return self->meta().generator.name; },
          "The name of the generator.")
      .def_property_readonly(
          "seed", [](const Self<OpenWorldView>& self) { return self->meta().generator.seed; },
          "The seed of the generator.")
      .def_property_readonly("materials", &world_materials,
                             "The material table as a list. A voxel is an index of it.")
      .def_property_readonly("visibility", &world_visibility,
                             "The visibility of each material as an array for Chunk.mesh().")
      .def_property_readonly("players", &world_players, "The names of the players by their number.")
      .def_property_readonly(
          "loss",
          [](const Self<OpenWorldView>& self) -> py::object {
            const std::string text = read_world([&] { return self->loss(); });
            return text.empty() ? py::none() : py::object(py::str(text));
          },
          "What the world has lost of its durable edits, as a text, or None.")
      .def("__repr__", [](const Self<OpenWorldView>& self) {
        return "<runstone.World at " + place_name(self->place()) + ">";
      });
}

}  // namespace runstone::python
