// Which values are refused of chat lines, keys for another device and added materials.
#include <optional>
#include <string>
#include <vector>

#include "tests/unit/protocol/codec/built_message.hpp"

namespace runstone::test {
namespace {

struct ChatLineFields {
  std::uint8_t kind = 1;
  std::uint32_t author = 7;
  std::string name = "ann", text = "hi";
  std::int64_t utc_us = 5;
  std::size_t count = 1;
  Offset<wire::ChatLines> operator()(FlatBufferBuilder& b) const {
    std::vector<Offset<wire::ChatLine>> lines;
    for (std::size_t i = 0; i < count; ++i) {
      const auto n = b.CreateString(name);
      const auto t = b.CreateString(text);
      lines.push_back(wire::CreateChatLine(b, kind, author, n, t, utc_us));
    }
    return wire::CreateChatLines(b, b.CreateVector(lines));
  }
};

struct WithdrawnLineFields {
  std::string name = "ann";
  std::int64_t utc_us = 5;
  std::size_t count = 1;
  Offset<wire::ChatWithdrawn> operator()(FlatBufferBuilder& b) const {
    std::vector<Offset<wire::ChatLineId>> lines;
    for (std::size_t i = 0; i < count; ++i)
      lines.push_back(wire::CreateChatLineId(b, utc_us, b.CreateString(name)));
    return wire::CreateChatWithdrawn(b, b.CreateVector(lines));
  }
};

struct KeyDepositFields {
  std::size_t slot = kKeySlotBytes, sealed = 1, signature = kSignatureBytes;
  Offset<wire::KeyDeposit> operator()(FlatBufferBuilder& b) const {
    const Vector s = filled(b, slot);
    const Vector k = filled(b, sealed);
    return wire::CreateKeyDeposit(b, s, k, filled(b, signature));
  }
};

struct AddedMaterialFields {
  std::uint32_t first = 24;
  std::vector<std::string> names = {"lamp", "ice"};
  std::uint32_t rgba = 0xff00'0000;
  std::uint8_t visibility = 1;
  std::optional<wire::MaterialLook> look;
  Offset<wire::MaterialsAdded> operator()(FlatBufferBuilder& b) const {
    std::vector<Offset<wire::MaterialRow>> rows;
    for (const std::string& name : names)
      rows.push_back(wire::CreateMaterialRow(b, b.CreateString(name), rgba, visibility, 0,
                                             look ? &*look : nullptr));
    return wire::CreateMaterialsAdded(b, first, b.CreateVector(rows));
  }
};

}  // namespace

TEST_CASE("chat lines are refused with a bad text, name, time or number of lines", "[protocol]") {
  refuses<ChatLines, ChatLineFields>({
      [](auto& l) { l.kind = 0; },
      [](auto& l) { l.kind = 2; },  // the host's lines have no name
      [](auto& l) { l.kind = 2, l.name = ""; },
      [](auto& l) { l.name = ""; },
      [](auto& l) { l.name = " ann"; },
      [](auto& l) { l.name = std::string(33, 'a'); },
      [](auto& l) { l.text = ""; },
      [](auto& l) { l.text = std::string(kChatBytesMax + 1, 'a'); },
      [](auto& l) { l.text = "a\nb"; },
      [](auto& l) { l.utc_us = kWireTimeUsMax + 1; },
      [](auto& l) { l.count = 0; },
      [](auto& l) { l.count = kChatLinesMax + 1; },
  });
  CHECK(passes<ChatLines>(ChatLineFields{200, 0, "", "of a later version", 5, kChatLinesMax}));
}

TEST_CASE("withdrawn chat lines are refused with a bad name, time or number of lines",
          "[protocol]") {
  refuses<ChatWithdrawn, WithdrawnLineFields>({
      [](auto& l) { l.name = ""; },
      [](auto& l) { l.name = " ann"; },
      [](auto& l) { l.name = std::string(33, 'a'); },
      [](auto& l) { l.utc_us = kWireTimeUsMax + 1; },
      [](auto& l) { l.count = 0; },
      [](auto& l) { l.count = kChatWithdrawnMax + 1; },
  });
  CHECK(passes<ChatWithdrawn>(WithdrawnLineFields{"ann", -5, kChatWithdrawnMax}));
}

TEST_CASE("a key for another device is refused with a slot or a seal of the wrong size",
          "[protocol]") {
  refuses<KeyDeposit, KeyDepositFields>({
      [](auto& k) { k.slot = kKeySlotBytes - 1; },
      [](auto& k) { k.slot = kKeySlotBytes + 1; },
      [](auto& k) { k.sealed = 0; },
      [](auto& k) { k.sealed = kSealedKeyBytesMax + 1; },
      [](auto& k) { k.signature = kSignatureBytes - 1; },
  });
  CHECK(passes<KeyDeposit>(KeyDepositFields{kKeySlotBytes, kSealedKeyBytesMax}));
}

TEST_CASE("added materials are refused outside the table, unnamed, twice or half transparent",
          "[protocol]") {
  refuses<MaterialsAdded, AddedMaterialFields>({
      [](auto& m) { m.first = 0; },
      [](auto& m) { m.first = kMaterialCountMax - 1; },
      [](auto& m) { m.names.clear(); },
      [](auto& m) { m.names[1] = ""; },
      [](auto& m) { m.names[1] = m.names[0]; },
      [](auto& m) { m.names[1] = std::string(kMaterialNameBytesMax + 1, 'a'); },
      [](auto& m) { m.rgba = 0x7f00'0000; },  // opaque with alpha
      [](auto& m) { m.visibility = 3; },
  });
  AddedMaterialFields last;
  last.first = kMaterialCountMax - 2;
  CHECK(passes<MaterialsAdded>(last));
}

TEST_CASE("a silly look of a material is taken for the nearest valid one", "[protocol]") {
  const auto look_from = [](const std::optional<wire::MaterialLook>& look) {
    AddedMaterialFields fields;
    fields.look = look;
    const auto message = received<MaterialsAdded>(fields);
    REQUIRE(message.has_value());
    return std::get<MaterialsAdded>(*message).rows.at(1).look;
  };
  CHECK(look_from(std::nullopt) == std::nullopt);
  CHECK(look_from(wire::MaterialLook(1, 2, 3, 100, 6)) ==
        MaterialLook{1, 2, 3, 100, MaterialPattern::weave});
  CHECK(look_from(wire::MaterialLook(101, 255, 200, 255, kMaterialPatterns)) ==
        MaterialLook{100, 100, 100, 100, MaterialPattern::none});
}

}  // namespace runstone::test
