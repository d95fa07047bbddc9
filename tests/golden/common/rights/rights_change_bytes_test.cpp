#include <algorithm>
#include <catch2/catch.hpp>

#include "common/rights/rights_change.hpp"

// Bytes derived by hand. They are stored in logs: a change here is a new kind.
namespace runstone::test {
namespace {

PublicKey counting_key(std::uint8_t first) {
  PublicKey key;
  for (std::uint8_t& byte : key) byte = first++;
  return key;
}

Bytes joined(std::initializer_list<Bytes> parts) {
  Bytes out;
  for (const Bytes& part : parts) out.insert(out.end(), part.begin(), part.end());
  return out;
}

Bytes key_bytes(std::uint8_t first) {
  const PublicKey key = counting_key(first);
  return {key.begin(), key.end()};
}

void check_change_bytes(const RightsChange& change, const Bytes& golden) {
  Bytes out;
  encode(change, out);
  CHECK(out == golden);
  ByteReader in(golden);
  const RightsChange read = read_rights_change(in);
  REQUIRE(in.ok());
  CHECK(read == change);
}

}  // namespace

TEST_CASE("the bytes of changes of roles are pinned", "[rights][golden]") {
  check_change_bytes(DefineRole{{"guard", {Right::see, Right::moderate}, 300, 5, 1'310'720}},
                     {0x01, 5, 'g', 'u', 'a', 'r', 'd', 0x81, 0x04,  // rights: bits 0 and 9
                      0xac, 0x02,                                    // 300 voxels of one edit
                      0x05,                                          // claims
                      0x80, 0x80, 0x50});                            // voxels of all claims
  Role guest{"g", {Right::see}, 0, 0, 0};
  guest.edit_budget = {25, 1'000};
  guest.view_radius_max = 8;
  guest.chunk_loads_per_second = 300;
  check_change_bytes(DefineRole{guest}, {0x0e, 1, 'g', 0x01, 0, 0, 0,  // 14: a role with quotas
                                         25, 0xe8, 0x07,               // units a second, at once
                                         8,                            // chunks of a view
                                         0xac, 0x02});                 // 300 chunks a second
  check_change_bytes(RemoveRole{"a.b"}, {0x02, 3, 'a', '.', 'b'});
  check_change_bytes(GrantRole{counting_key(0x40), "guard"},
                     joined({{0x03}, key_bytes(0x40), {5, 'g', 'u', 'a', 'r', 'd'}}));
  check_change_bytes(GrantRole{counting_key(0x40), ""}, joined({{0x03}, key_bytes(0x40), {0}}));
  check_change_bytes(SetDefaultRole{"visitor"}, {0x04, 7, 'v', 'i', 's', 'i', 't', 'o', 'r'});
}

TEST_CASE("the bytes of restrictions are pinned", "[rights][golden]") {
  check_change_bytes(
      Restrict{RestrictionKind::freeze, counting_key(0x10), 1'700'000'000'000'000, "caf\xc3\xa9"},
      joined({{0x05, 0x02, 0x00},
              key_bytes(0x10),
              {0x80, 0x80, 0xf9, 0xc0, 0xc1, 0xc4, 0x82, 0x03},  // microseconds
              {5, 'c', 'a', 'f', 0xc3, 0xa9}}));
  check_change_bytes(
      Restrict{RestrictionKind::ban, AddressRange{address_block_v4(0xc000'0200), 56}, 0, ""},
      {0x05, 0x00, 0x01,                                // ban of a range
       0x00, 0x02, 0x00, 0xc0, 0xff, 0xff, 0x00, 0x00,  // first block, little-endian
       0x38, 0x00, 0x00});                              // 56 bits, no end, no reason
  check_change_bytes(Lift{RestrictionKind::mute, counting_key(0x10)},
                     joined({{0x06, 0x01, 0x00}, key_bytes(0x10)}));
}

TEST_CASE("the bytes of invites are pinned", "[rights][golden]") {
  check_change_bytes(CreateInvite{{0x0123456789abcdef, "mason", 5, 300}},
                     {0x09, 0xef, 0xcd, 0xab, 0x89, 0x67, 0x45, 0x23, 0x01, 5, 'm', 'a', 's', 'o',
                      'n', 5, 0xac, 0x02});
  check_change_bytes(
      AcceptInvite{1, counting_key(0x10)},
      joined({{0x0a, 0x01, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00}, key_bytes(0x10)}));
  check_change_bytes(CancelInvite{1}, {0x0b, 0x01, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00});
}

TEST_CASE("the bytes of passwords are pinned", "[rights][golden]") {
  JoinPassword password{"mason", {}, {}};
  std::copy_n(counting_key(0x50).begin(), kPasswordSaltBytes, password.salt.begin());
  password.hash = counting_key(0x60);
  const Bytes salt(password.salt.begin(), password.salt.end());
  check_change_bytes(SetPassword{password},
                     joined({{0x0c, 5, 'm', 'a', 's', 'o', 'n'}, salt, key_bytes(0x60)}));
  check_change_bytes(SetPassword{}, {0x0c, 0});
  check_change_bytes(AcceptPassword{counting_key(0x10)}, joined({{0x0d}, key_bytes(0x10)}));
}

TEST_CASE("the bytes of protected boxes are pinned", "[rights][golden]") {
  ProtectedBox box;
  box.name = "home";
  box.box = {{-1, -kWorldLimit, 100}, {0, kWorldLimit, 228}};
  box.priority = -1;
  check_change_bytes(Protect{box}, {0x07, 4,    'h',  'o',  'm',  'e',  0x01,
                                    0xff, 0xff, 0xff, 0xff, 0x03, 0xc8, 0x01,  // min
                                    0x00, 0xff, 0xff, 0xff, 0xff, 0x03, 0x7f,  // sides - 1
                                    0x01, 0x00, 0x00, 0x00});                  // priority; nobody
  box.box = {{0, 0, 0}, {1, 1, 1}};
  box.priority = 1000;
  box.owner = counting_key(0x20);
  box.members = {counting_key(0x00), counting_key(0x01)};
  box.roles = {"a", "b"};
  check_change_bytes(Protect{box}, joined({{0x07, 4, 'h', 'o', 'm', 'e', 0, 0, 0, 0, 0, 0},
                                           {0xd0, 0x0f, 0x01},
                                           key_bytes(0x20),
                                           {0x02},
                                           key_bytes(0x00),
                                           key_bytes(0x01),
                                           {0x02, 1, 'a', 1, 'b'}}));
  check_change_bytes(Unprotect{"home"}, {0x08, 4, 'h', 'o', 'm', 'e'});
}

}  // namespace runstone::test
