"""The maker's exceptions: other names of our errors, for programs that catch them."""

from __future__ import annotations

from cobotwire.protocol.errors import UsageError

# The library raises one of these for an argument that it does not allow.
MyCobotDataException = UsageError
MyCobot280DataException = UsageError
MyCobot320DataException = UsageError
MechArmDataException = UsageError
MyArmDataException = UsageError
MyArmMDataException = UsageError
MyArmCDataException = UsageError
MyBuddyDataException = UsageError
MyPalletizerDataException = UsageError
MyPalletizer260DataException = UsageError
MercuryDataException = UsageError
MercuryRobotException = UsageError
MyCobot630ProDataException = UsageError
MyCobotPro450DataException = UsageError
