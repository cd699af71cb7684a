//! Read the joints of an arm five times at 20 Hz: `watch socket://127.0.0.1:9000`.

use cobotwire::editions::mycobot280::{AsyncMyCobot280, messages::GetAngles};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let port = std::env::args().nth(1).ok_or("watch needs a port")?;
    let runtime = tokio::runtime::Builder::new_current_thread()
        .enable_all()
        .build()?;
    runtime.block_on(async {
        let arm = AsyncMyCobot280::open(&port).await?;
        let mut samples = arm.poll(GetAngles {}, 20.0)?;
        for _ in 0..5 {
            println!(
                "{:?}",
                samples.next().await.transpose()?.map(|sample| sample.value)
            );
        }
        println!("{} missed", samples.missed());
        arm.close().await;
        Ok(())
    })
}
