import { MyCobot280 } from "cobotwire/mycobot280";

const arm = await MyCobot280.open(process.argv[2] ?? "/dev/ttyACM0");
await arm.powerOn();
await arm.sendAngles([0, -20, 30, 0, 10, 0], 80); // degrees, percent
const [j1, ...others] = await arm.getAngles();
console.log(j1, others);
await arm.close();
