# Headless runstone-client (software rendering, no X server), of its Debian packages (docs/packages.md). Build from the repository root:
#   docker build -f docker/client.Dockerfile -t runstone-client .
FROM debian:bookworm-slim AS build
RUN apt-get update && apt-get install -y --no-install-recommends \
      ca-certificates cmake dpkg-dev file ninja-build g++ pkg-config libasio-dev libflatbuffers-dev flatbuffers-compiler \
      flatbuffers-compiler-dev libspdlog-dev libfmt-dev libsqlite3-dev libpq-dev libzstd-dev libxxhash-dev libhwy-dev libsodium-dev libssl-dev libutf8proc-dev libicu-dev \
      libcli11-dev libtomlplusplus-dev nlohmann-json3-dev libboost-dev prometheus-cpp-dev libegl-dev libgl-dev libosmesa6-dev libglfw3-dev libglm-dev \
      libimgui-dev libfreetype-dev libdeflate-dev liblz4-dev libleveldb-dev libpng-dev zlib1g-dev python3-glad libstb-dev libassimp-dev && rm -rf /var/lib/apt/lists/*
WORKDIR /src
COPY CMakeLists.txt CMakePresets.json LICENSE CHANGELOG.md ./
COPY cmake cmake
COPY bindings bindings
COPY common common
COPY packaging packaging
COPY protocol protocol
COPY server server
COPY client client
RUN cmake --preset release -DRUNSTONE_TESTS=OFF && \
    cmake --build --preset release --target package_files && \
    cd build/release && cpack -B /packages

FROM debian:bookworm-slim
COPY --from=build /packages/*.deb /packages/
RUN groupadd --gid 10001 runstone && useradd --uid 10001 --gid 10001 runstone && \
    apt-get update && apt-get install -y --no-install-recommends \
      /packages/runstone-client_*.deb /packages/runstone-tools_*.deb libgl1-mesa-dri libegl-mesa0 fonts-dejavu-core && \
    rm -rf /packages /var/lib/apt/lists/* && install -d -o runstone -g runstone /out
USER runstone
WORKDIR /out
VOLUME /out
ENTRYPOINT ["runstone-client", "--headless"]
