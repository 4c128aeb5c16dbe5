//! Compiles the part that is C++ and links Bullet.

fn main() {
    println!("cargo::rerun-if-changed=src/bullet.cpp");
    if std::env::var_os("CARGO_FEATURE_BULLET").is_none() {
        return;
    }
    let bullet = match pkg_config::Config::new().cargo_metadata(false).probe("bullet") {
        Ok(bullet) => bullet,
        Err(e) => {
            eprintln!("Bullet is not installed: apt-get install libbullet-dev pkg-config g++\n{e}");
            std::process::exit(1);
        }
    };
    let mut build = cc::Build::new();
    build.cpp(true).std("c++14").opt_level(3).warnings(false).includes(&bullet.include_paths);
    for (name, value) in &bullet.defines {
        build.define(name, value.as_deref());
    }
    build.file("src/bullet.cpp").compile("taut_peers_bullet");
    for path in &bullet.link_paths {
        println!("cargo::rustc-link-search={}", path.display());
    }
    for lib in ["BulletSoftBody", "BulletDynamics", "BulletCollision", "LinearMath"] {
        println!("cargo::rustc-link-lib=dylib={lib}");
    }
    println!("cargo::rustc-env=BULLET_VERSION={}", bullet.version);
}
