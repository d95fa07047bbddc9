// The program of a project that takes Runstone as a subdirectory.
#include <cstdio>

#include "common/runs/run_chunk.hpp"

int main() {
  runstone::RunChunk chunk = runstone::uniform_chunk(runstone::Extent::cube(16), 1);
  runstone::fill(chunk, 100, 10, 2);
  std::printf("%zu runs\n", chunk.runs.size());
}
