//! Read the joints of an arm, and move it home: `first socket://127.0.0.1:9000`.
use cobotwire::editions::mycobot280::MyCobot280;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arm = MyCobot280::open(&std::env::args().nth(1).unwrap_or_default())?;
    arm.power_on()?;
    println!("the joints are at {:?}", arm.get_angles()?);
    arm.acknowledged(std::time::Duration::from_secs(1))
        .send_angles([10.0; 6], 50)?;
    arm.close();
    Ok(())
}
