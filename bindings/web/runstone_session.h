/* runstone_session.h: the functions that the JavaScript of @runstone/core calls beside those of
 * runstone.h, with the same rules for handles, statuses and buffers. They are no part of the C
 * interface. They may change with each version, because the package contains both sides.
 *
 * A session carries no bytes and reads no clock: JavaScript has the WebSocket and passes the time
 * in milliseconds. See CarriedSession. */
#ifndef RUNSTONE_SESSION_H
#define RUNSTONE_SESSION_H

#include "bindings/c/runstone.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct runstone_session runstone_session;

typedef struct runstone_session_info {
  uint32_t struct_size;
  uint32_t is_open;     /* 1: the world is open */
  uint32_t wants_close; /* 1: close the connection */
  uint32_t is_loaded;   /* 1: every chunk of the view has arrived or is unavailable */
  uint32_t edge;        /* of chunks; 0 before the world is open */
  uint32_t author;      /* the number of this player */
  uint32_t materials;   /* the number of them, air included; 0 before the first welcome */
  uint32_t chunks;      /* that are held */
  uint32_t unmeshed;    /* chunks that runstone_session_next_mesh() will give */
  uint32_t pending;     /* edits without an answer */
  uint32_t has_place;   /* 1: the server knows where the player was last */
  uint32_t reserved;    /* 0 */
  runstone_vec place;   /* the last place of the player; otherwise the spawn point of the world */
} runstone_session_info;

typedef struct runstone_session_material {
  uint32_t struct_size;
  uint32_t visibility; /* RUNSTONE_EMPTY, OPAQUE or TRANSPARENT */
  uint8_t colour[4];   /* sRGB and alpha */
  uint32_t is_cube;    /* 0: it has a shape */
} runstone_session_material;

/* Makes a session of a player. `seed` is the secret key of the player, 32 bytes. `instance` is
 * random. Names and tickets are UTF-8. Refuses names and tickets that no server accepts. An empty
 * ticket means no invite. The radii are chunks, 0 .. 32. */
RUNSTONE_API runstone_status runstone_session_create(const uint8_t seed[32], const char* name,
                                                     const char* ticket, uint32_t instance,
                                                     uint32_t radius_h, uint32_t radius_v,
                                                     runstone_session** out);
RUNSTONE_API runstone_status runstone_session_free(runstone_session* session);
/* Begins a connection. `nonce` is 32 fresh random bytes. */
RUNSTONE_API runstone_status runstone_session_connected(runstone_session* session,
                                                        const uint8_t nonce[32], double now_ms);
RUNSTONE_API runstone_status runstone_session_disconnected(runstone_session* session);
/* Takes a message of the WebSocket. Refuses bytes that break the protocol. The caller then closes
 * the connection. */
RUNSTONE_API runstone_status runstone_session_receive(runstone_session* session,
                                                      const uint8_t* bytes, size_t count,
                                                      double now_ms);
RUNSTONE_API runstone_status runstone_session_step(runstone_session* session, double now_ms);
/* Gives the next message to send, which holds until the next call, or a count of 0. */
RUNSTONE_API runstone_status runstone_session_next_frame(runstone_session* session,
                                                         const uint8_t** bytes, size_t* count);
RUNSTONE_API runstone_status runstone_session_get_info(const runstone_session* session,
                                                       runstone_session_info* out);
/* Gives the oldest notice, which holds until the next call. *kind is 0 if there is none. */
RUNSTONE_API runstone_status runstone_session_next_notice(runstone_session* session, uint32_t* kind,
                                                          uint32_t* number, const char** text,
                                                          size_t* text_bytes);
/* Describes a material. The name holds until the next message is received. */
RUNSTONE_API runstone_status runstone_session_get_material(const runstone_session* session,
                                                           uint32_t material,
                                                           runstone_session_material* out,
                                                           const char** name, size_t* name_bytes);
/* Moves the eye, and the view with it. Before the world is open, the view moves when it opens. Yaw 0
 * looks along +z and grows towards +x; pitch is positive upward; radians. */
RUNSTONE_API runstone_status runstone_session_move(runstone_session* session, runstone_vec eye,
                                                   double yaw, double pitch);
/* Shows an edit at once and sends it. *number names the edit in later notices. */
RUNSTONE_API runstone_status runstone_session_edit(runstone_session* session, const uint8_t* bytes,
                                                   size_t count, double now_ms, uint32_t* number);
RUNSTONE_API runstone_status runstone_session_chat(runstone_session* session, const char* text,
                                                   size_t text_bytes);
/* Sends a command, such as "undo". A notice has its output. Refuses another command before the first
 * has ended. */
RUNSTONE_API runstone_status runstone_session_command(runstone_session* session, const char* text,
                                                      size_t text_bytes);
RUNSTONE_API runstone_status runstone_session_leave(runstone_session* session);
/* Makes the next mesh that is out of date. *has_mesh becomes 0 if there is none, 1 if `mesh` is the
 * mesh of the chunk *at, and 2 if that chunk has none any more. */
RUNSTONE_API runstone_status runstone_session_next_mesh(runstone_session* session,
                                                        runstone_mesh* mesh, runstone_pos* at,
                                                        uint32_t* has_mesh);
/* Gives a copy of a chunk as it is shown. Refuses chunks that are not held. */
RUNSTONE_API runstone_status runstone_session_chunk(const runstone_session* session,
                                                    runstone_pos at, runstone_chunk** out);
/* Gives the material of a voxel as it is shown. *is_known becomes 0 where no chunk is held. */
RUNSTONE_API runstone_status runstone_session_get(const runstone_session* session, runstone_pos at,
                                                  uint16_t* material, uint32_t* is_known);
/* Finds the first voxel along a ray, as runstone_space_pick() does. */
RUNSTONE_API runstone_status runstone_session_pick(const runstone_session* session,
                                                   runstone_vec eye, runstone_vec direction,
                                                   double reach, runstone_ray* out);

#ifdef __cplusplus
}
#endif
#endif
