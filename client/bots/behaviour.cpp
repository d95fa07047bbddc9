#include "client/bots/behaviour.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "client/bots/house.hpp"

namespace runstone {
namespace {

constexpr double kEyeAbove =
    12;  // voxels above the height of the spawn: ground and roofs are in view
constexpr double kWalkSpeed = 4;  // voxels a second
constexpr double kRunSpeed = 64;  // two chunks of edge 32 a second
constexpr std::int32_t kPlotsAlong = kSiteSide / kPlotSide;
/// Depth in voxels, below the highest ground of a plot, down to which a foundation is filled.
constexpr std::int32_t kBuriedMax = 24;

std::int32_t down(double v) { return static_cast<std::int32_t>(std::floor(v)); }

WorldPos above_middle(VoxelPos corner) {
  return {corner.x + kSiteSide / 2.0, corner.y + kEyeAbove, corner.z + kSiteSide / 2.0};
}

class Idle final : public Behaviour {
 public:
  explicit Idle(const BotPlace& place) : at_(above_middle(site_corner(place))) {}
  WorldPos position(double /*seconds*/) const override { return at_; }
  std::optional<EditDescriptor> next_edit(const GroundHeight& /*ground*/) override {
    return std::nullopt;
  }

 private:
  WorldPos at_;
};

class Walk final : public Behaviour {
 public:
  explicit Walk(const BotPlace& place) : middle_(above_middle(site_corner(place))) {}
  WorldPos position(double seconds) const override {
    const double radius = kSiteSide / 2.0, angle = seconds * kWalkSpeed / radius;
    return {middle_.x + radius * std::cos(angle), middle_.y, middle_.z + radius * std::sin(angle)};
  }
  std::optional<EditDescriptor> next_edit(const GroundHeight& /*ground*/) override {
    return std::nullopt;
  }

 private:
  WorldPos middle_;
};

class RunAway final : public Behaviour {
 public:
  RunAway(const BotPlace& place, std::uint64_t seed) : from_(above_middle(site_corner(place))) {
    SplitMix64 random(seed);
    angle_ = random.between(0, 359) * std::numbers::pi / 180;
  }
  WorldPos position(double seconds) const override {
    const double distance = seconds * kRunSpeed;
    return {from_.x + distance * std::cos(angle_), from_.y, from_.z + distance * std::sin(angle_)};
  }
  std::optional<EditDescriptor> next_edit(const GroundHeight& /*ground*/) override {
    return std::nullopt;
  }

 private:
  WorldPos from_;
  double angle_ = 0;
};

class Build final : public Behaviour {
 public:
  Build(const BotPlace& place, const MaterialTable& materials, std::uint64_t seed)
      : corner_(site_corner(place)), materials_(materials), random_(seed) {}

  WorldPos position(double /*seconds*/) const override { return above_middle(corner_); }

  std::optional<EditDescriptor> next_edit(const GroundHeight& ground) override {
    if (ground_.empty() && next_ == plan_.size() && !begin_plot(ground)) return std::nullopt;
    if (!ground_.empty()) {
      const EditDescriptor edit = ground_.back();
      ground_.pop_back();
      return edit;
    }
    const Placement& placement = plan_[next_++];
    return EditDescriptor{SetVoxel{placement.at}, {}, placement.material};
  }

 private:
  // Clears the plot, fills a foundation below it the first time, and plans the house.
  bool begin_plot(const GroundHeight& ground) {
    const VoxelPos plot = {corner_.x + plot_ % kPlotsAlong * kPlotSide, 0,
                           corner_.z + plot_ / kPlotsAlong % kPlotsAlong * kPlotSide};
    auto& level = levels_[static_cast<std::size_t>(plot_ % (kPlotsAlong * kPlotsAlong))];
    std::int32_t lowest = 0;
    if (!level) {
      std::optional<std::int32_t> highest;
      for (const std::int32_t dx : {0, kPlotSide / 2, kPlotSide - 1}) {
        for (const std::int32_t dz : {0, kPlotSide / 2, kPlotSide - 1}) {
          const auto top = ground.surface(plot.x + dx, plot.z + dz);
          if (!top) return false;
          lowest = highest ? std::min(lowest, *top) : *top;
          highest = std::max(highest.value_or(*top), *top);
        }
      }
      level = *highest + 1;
    }
    const VoxelPos floor = {plot.x, *level, plot.z};
    const HouseMaterials materials = draw_house_materials(materials_, random_);
    const VoxelBox above = {floor, {plot.x + kPlotSide, *level + kHouseHeight, plot.z + kPlotSide}};
    const VoxelBox below = {{plot.x, std::max(lowest, *level - kBuriedMax), plot.z},
                            {plot.x + kPlotSide, *level, plot.z + kPlotSide}};
    ground_.push_back({FillBox{above}, {MaskKind::only_solid, kEmpty}, kEmpty});
    if (plot_ < kPlotsAlong * kPlotsAlong) {
      ground_.push_back({FillBox{below}, {MaskKind::only_empty, kEmpty}, materials.foundation});
    }
    plan_ = plan_house(floor, materials, random_);
    next_ = 0;
    ++plot_;
    return true;
  }

  VoxelPos corner_;
  const MaterialTable& materials_;
  SplitMix64 random_;
  std::int32_t plot_ = 0;  // rises without end; plots are reused in order
  std::array<std::optional<std::int32_t>, static_cast<std::size_t>(kPlotsAlong) * kPlotsAlong>
      levels_;
  std::vector<EditDescriptor> ground_;  // the next edit is the last element
  std::vector<Placement> plan_;
  std::size_t next_ = 0;
};

class Brush final : public Behaviour {
 public:
  Brush(const BotPlace& place, const MaterialTable& materials, std::uint64_t seed)
      : corner_(site_corner(place)), materials_(materials), random_(seed) {}

  WorldPos position(double /*seconds*/) const override { return above_middle(corner_); }

  std::optional<EditDescriptor> next_edit(const GroundHeight& ground) override {
    const auto from = on_ground(ground), to = on_ground(ground);
    if (!from || !to) return std::nullopt;
    const auto radius = static_cast<std::uint16_t>(random_.between(2, 5));
    const auto material =
        static_cast<Material>(random_.below(static_cast<std::uint32_t>(materials_.size())));
    if (random_.below(2) == 0 || *from == *to)
      return EditDescriptor{FillSphere{*from, radius}, {}, material};
    return EditDescriptor{FillStroke{{*from, *to}, radius}, {}, material};
  }

 private:
  std::optional<VoxelPos> on_ground(const GroundHeight& ground) {
    const std::int32_t x = corner_.x + random_.between(6, kSiteSide - 7);
    const std::int32_t z = corner_.z + random_.between(6, kSiteSide - 7);
    const auto y = ground.surface(x, z);
    if (!y) return std::nullopt;
    return VoxelPos{x, *y, z};
  }

  VoxelPos corner_;
  const MaterialTable& materials_;
  SplitMix64 random_;
};

class Grief final : public Behaviour {
 public:
  Grief(const BotPlace& place, const MaterialTable& materials, std::uint64_t seed)
      : place_(place), materials_(materials), random_(seed) {
    move_to_next_site();
  }

  WorldPos position(double /*seconds*/) const override { return above_middle(corner_); }

  std::optional<EditDescriptor> next_edit(const GroundHeight& ground) override {
    if (left_ == 0) move_to_next_site();
    const std::int32_t x = corner_.x + random_.between(0, kSiteSide - 1);
    const std::int32_t z = corner_.z + random_.between(0, kSiteSide - 1);
    const auto y = ground.surface(x, z);
    if (!y) return std::nullopt;
    --left_;
    const VoxelPos at = {x, *y, z};
    switch (random_.below(3)) {
      case 0:  // a crater
        return EditDescriptor{
            FillSphere{at, static_cast<std::uint16_t>(random_.between(2, 6))}, {}, kEmpty};
      case 1: {  // a pillar through what is built there
        const VoxelBox box = {{x - 1, *y - 2, z - 1}, {x + 1, *y + 12, z + 1}};
        return EditDescriptor{FillBox{box}, {}, paint()};
      }
      default: {  // a stroke across the roofs
        const VoxelPos end = {x + random_.between(1, 16), *y + random_.between(0, 3),
                              z + random_.between(1, 16)};
        return EditDescriptor{FillStroke{{at, end}, 1}, {}, paint()};
      }
    }
  }

 private:
  // Moves to a random site for some edits. The view moves, too.
  void move_to_next_site() {
    BotPlace victim = place_;
    victim.index = random_.below(static_cast<std::uint32_t>(place_.count));
    corner_ = site_corner(victim);
    left_ = 8;
  }
  Material paint() const {
    for (const std::string_view name : {"wool_black", "wool_pink"}) {
      if (const auto found = materials_.find(name)) return *found;
    }
    return static_cast<Material>(materials_.size() - 1);
  }

  BotPlace place_;
  const MaterialTable& materials_;
  SplitMix64 random_;
  VoxelPos corner_;
  int left_ = 0;
};

}  // namespace

std::optional<BotRole> bot_role(std::string_view name) {
  constexpr std::array<std::pair<std::string_view, BotRole>, 7> kRoles = {
      {{"idle", BotRole::idle},
       {"walk", BotRole::walk},
       {"run-away", BotRole::run_away},
       {"build", BotRole::build},
       {"brush", BotRole::brush},
       {"griefer", BotRole::grief},
       {"join-storm", BotRole::join_storm}}};
  for (const auto& [known, role] : kRoles) {
    if (known == name) return role;
  }
  return std::nullopt;
}

VoxelPos site_corner(const BotPlace& place) {
  const auto along =
      static_cast<std::int32_t>(std::ceil(std::sqrt(static_cast<double>(place.count))));
  const auto index = static_cast<std::int32_t>(place.index);
  return {down(place.spawn.x) + (index % along) * kSiteSide - along * kSiteSide / 2,
          down(place.spawn.y),
          down(place.spawn.z) + (index / along) * kSiteSide - along * kSiteSide / 2};
}

std::unique_ptr<Behaviour> make_behaviour(BotRole role, const BotPlace& place,
                                          const MaterialTable& materials, std::uint64_t seed) {
  switch (role) {
    case BotRole::idle:
    case BotRole::join_storm:
      return std::make_unique<Idle>(place);
    case BotRole::run_away:
      return std::make_unique<RunAway>(place, seed);
    case BotRole::walk:
      return std::make_unique<Walk>(place);
    case BotRole::build:
      return std::make_unique<Build>(place, materials, seed);
    case BotRole::brush:
      return std::make_unique<Brush>(place, materials, seed);
    case BotRole::grief:
      return std::make_unique<Grief>(place, materials, seed);
  }
  return nullptr;
}

}  // namespace runstone
