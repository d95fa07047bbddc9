# runstone-server: built in one stage, copied without compilers into the next. Build from the
# repository root:
#   docker build -f docker/server.Dockerfile -t runstone-server .
FROM debian:bookworm-slim AS build
RUN apt-get update && apt-get install -y --no-install-recommends \
      ca-certificates cmake ninja-build g++ pkg-config libasio-dev libflatbuffers-dev flatbuffers-compiler \
      flatbuffers-compiler-dev libspdlog-dev libfmt-dev libsqlite3-dev libpq-dev libzstd-dev libxxhash-dev libhwy-dev libsodium-dev libssl-dev libutf8proc-dev libicu-dev \
      libcli11-dev libtomlplusplus-dev nlohmann-json3-dev libboost-dev prometheus-cpp-dev libdeflate-dev liblz4-dev libleveldb-dev libpng-dev zlib1g-dev libstb-dev libassimp-dev && rm -rf /var/lib/apt/lists/*
WORKDIR /src
COPY CMakeLists.txt CMakePresets.json ./
COPY cmake cmake
COPY common common
COPY protocol protocol
COPY server server
RUN cmake --preset release -DRUNSTONE_CLIENT=OFF -DRUNSTONE_TESTS=OFF && \
    cmake --build --preset release --target runstone-server runstone-replay runstone-web runstone-read-model && \
    strip build/release/bin/runstone-server build/release/bin/runstone-replay build/release/bin/runstone-web \
      build/release/bin/runstone-read-model

FROM debian:bookworm-slim
RUN apt-get update && apt-get install -y --no-install-recommends \
      libspdlog1.10 libfmt9 libsqlite3-0 libpq5 libzstd1 libhwy1 libsodium23 libssl3 libutf8proc2 libicu72 libxxhash0 libtomlplusplus3 libprometheus-cpp-core1.0 libdeflate0 liblz4-1 libleveldb1d libpng16-16 zlib1g libassimp5 && rm -rf /var/lib/apt/lists/* && \
    groupadd --gid 10001 runstone && useradd --uid 10001 --gid 10001 runstone && install -d -o runstone -g runstone /world /sockets
COPY --from=build /src/build/release/bin/runstone-server /src/build/release/bin/runstone-replay /src/build/release/bin/runstone-web /src/build/release/bin/runstone-read-model /usr/local/bin/
USER runstone
VOLUME /world
EXPOSE 4747
STOPSIGNAL SIGTERM
ENTRYPOINT ["runstone-server", "--world", "/world", "--create", "--listen", "0.0.0.0:4747"]
