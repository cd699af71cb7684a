"""Could anybody on the line tell this device from the right one? Asked without any tester."""
