# The program alone: docker run --rm -v "$PWD:/work" etalon render scene.xml
FROM rust:1-slim-bookworm AS build
WORKDIR /source
COPY . .
ARG COMMIT=unknown
RUN ETALON_COMMIT="$COMMIT" cargo build --release --locked -p etalon

FROM debian:bookworm-slim
COPY --from=build /source/target/release/etalon /usr/local/bin/etalon
COPY --from=build /source/LICENSE-APACHE /source/LICENSE-MIT /source/LICENSES-DATA.md /usr/share/doc/etalon/
WORKDIR /work
ENTRYPOINT ["etalon"]
