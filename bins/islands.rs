//! The program `islands`: see [`islands::app`].

fn main() -> std::process::ExitCode {
    islands::app::main()
}
