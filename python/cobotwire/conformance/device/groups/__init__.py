"""The test cases for devices, grouped by their requests; ``device.suite`` has their order."""
