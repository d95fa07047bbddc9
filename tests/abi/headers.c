/* Both headers compile as C99 with all warnings, and the sizes of structs, which programs are
 * compiled with, stay as they are. A negative size of an array is an error. */
#include <runstone.h>
#include <runstone_runs.h>

#define STAYS(name, type, size) typedef char name[sizeof(type) == (size) ? 1 : -1]
STAYS(runstone_size_pos, runstone_pos, 12);
STAYS(runstone_size_box, runstone_box, 24);
STAYS(runstone_size_vec, runstone_vec, 24);
STAYS(runstone_size_body, runstone_body, 48);
STAYS(runstone_size_local_box, runstone_local_box, 6);
STAYS(runstone_size_chunk_info, runstone_chunk_info, 32);
STAYS(runstone_size_brush, runstone_brush, 12);
STAYS(runstone_size_changes, runstone_changes, 64);
STAYS(runstone_size_quad_fields, runstone_quad_fields, 32);
STAYS(runstone_size_vertex, runstone_vertex, 36);
STAYS(runstone_size_sweep, runstone_sweep, 32);
STAYS(runstone_size_slide, runstone_slide, 32);
STAYS(runstone_size_ray, runstone_ray, 40);

int runstone_headers_compile(void);
int runstone_headers_compile(void) {
  runstone_runs runs;
  return (int)runstone_runs_open(&runs, NULL, 0) + (int)runstone_abi();
}
