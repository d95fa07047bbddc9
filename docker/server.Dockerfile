# runstone-server: its Debian packages are built in one stage, and installed without compilers in the next
# (docs/packages.md). Build from the repository root:
#   docker build -f docker/server.Dockerfile -t runstone-server .
FROM debian:bookworm-slim AS build
RUN apt-get update && apt-get install -y --no-install-recommends \
      ca-certificates cmake dpkg-dev file ninja-build g++ pkg-config libasio-dev libflatbuffers-dev flatbuffers-compiler \
      flatbuffers-compiler-dev libspdlog-dev libfmt-dev libsqlite3-dev libpq-dev libzstd-dev libxxhash-dev libhwy-dev libsodium-dev libssl-dev libutf8proc-dev libicu-dev \
      libcli11-dev libtomlplusplus-dev nlohmann-json3-dev libboost-dev prometheus-cpp-dev libdeflate-dev liblz4-dev libleveldb-dev libpng-dev zlib1g-dev libstb-dev libassimp-dev && rm -rf /var/lib/apt/lists/*
WORKDIR /src
COPY CMakeLists.txt CMakePresets.json LICENSE CHANGELOG.md ./
COPY cmake cmake
COPY bindings bindings
COPY common common
COPY packaging packaging
COPY protocol protocol
COPY server server
RUN cmake --preset release -DRUNSTONE_CLIENT=OFF -DRUNSTONE_TESTS=OFF && \
    cmake --build --preset release --target package_files && \
    cd build/release && cpack -B /packages

FROM debian:bookworm-slim
COPY --from=build /packages/*.deb /packages/
RUN groupadd --gid 10001 runstone && useradd --uid 10001 --gid 10001 runstone && \
    apt-get update && apt-get install -y --no-install-recommends \
      /packages/runstone-server_*.deb /packages/runstone-tools_*.deb /packages/runstone-web_*.deb && \
    rm -rf /packages /var/lib/apt/lists/* && install -d -o runstone -g runstone /world /sockets
USER runstone
VOLUME /world
EXPOSE 4747
STOPSIGNAL SIGTERM
ENTRYPOINT ["runstone-server", "--world", "/world", "--create", "--listen", "0.0.0.0:4747"]
