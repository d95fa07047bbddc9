# Headless runstone-client (software rendering, no X server). Build from the repository root:
#   docker build -f docker/client.Dockerfile -t runstone-client .
FROM debian:bookworm-slim AS build
RUN apt-get update && apt-get install -y --no-install-recommends \
      ca-certificates cmake ninja-build g++ pkg-config libasio-dev libflatbuffers-dev flatbuffers-compiler \
      flatbuffers-compiler-dev libspdlog-dev libfmt-dev libsqlite3-dev libpq-dev libzstd-dev libxxhash-dev libhwy-dev libsodium-dev libssl-dev libutf8proc-dev libicu-dev \
      libcli11-dev libtomlplusplus-dev nlohmann-json3-dev libboost-dev prometheus-cpp-dev libegl-dev libgl-dev libosmesa6-dev libglfw3-dev libglm-dev \
      libimgui-dev libfreetype-dev libdeflate-dev liblz4-dev libleveldb-dev libpng-dev zlib1g-dev python3-glad libstb-dev libassimp-dev && rm -rf /var/lib/apt/lists/*
WORKDIR /src
COPY CMakeLists.txt CMakePresets.json ./
COPY cmake cmake
COPY common common
COPY protocol protocol
COPY server server
COPY client client
RUN cmake --preset release -DRUNSTONE_TESTS=OFF && cmake --build --preset release --target runstone-client runstone-read-model && \
    strip build/release/bin/runstone-client build/release/bin/runstone-read-model

FROM debian:bookworm-slim
RUN apt-get update && apt-get install -y --no-install-recommends \
      libspdlog1.10 libfmt9 libsqlite3-0 libxxhash0 liblz4-1 libpng16-16 libzstd1 libhwy1 libsodium23 libssl3 libutf8proc2 libtomlplusplus3 libegl1 libegl-mesa0 libgl1-mesa-dri libosmesa6 libglfw3 libfreetype6 libstb0 libassimp5 fonts-dejavu-core \
      && rm -rf /var/lib/apt/lists/* && \
    groupadd --gid 10001 runstone && useradd --uid 10001 --gid 10001 runstone && install -d -o runstone -g runstone /out
COPY --from=build /src/build/release/bin/runstone-client /src/build/release/bin/runstone-read-model /usr/local/bin/
USER runstone
WORKDIR /out
VOLUME /out
ENTRYPOINT ["runstone-client", "--headless"]
