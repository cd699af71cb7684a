"""Code that must not type-check: each line that ends in `# wrong` is an error, and no other."""

from cobotwire import MyCobot


def drive(arm: MyCobot) -> None:
    """What a type checker must catch."""
    arm.send_angles("000000", speed=30)  # wrong
    arm.send_angles([0, 0, 0, 0, 0, 0])  # wrong
    arm.send_angles([0, 0, 0, 0, 0, 0], speed=2.5)  # wrong
    arm.send_angle(1, None, 20)  # wrong
    arm.send_angle(joint_id=1, angle=0, speed=20)  # wrong
    arm.set_free_mode("on")  # wrong
    arm.set_end_type("TOOL")  # wrong
    arm.get_angels()  # wrong
    angles: list[float] = arm.get_angles()  # wrong
    print(arm.get_coords().w)  # wrong
    print(angles)
