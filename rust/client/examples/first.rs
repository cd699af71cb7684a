//! Move an arm: `first socket://127.0.0.1:9000`.

fn main() -> Result<(), cobotwire::Error> {
    let port = std::env::args().nth(1).unwrap_or("/dev/ttyACM0".to_owned());
    let arm = cobotwire::editions::mycobot280::MyCobot280::open(&port)?;
    arm.power_on()?;
    arm.send_angles([0.0, -20.0, 30.0, 0.0, 10.0, 0.0], 80)?; // degrees, percent
    println!("{:?}", arm.get_angles()?);
    arm.close()
}
