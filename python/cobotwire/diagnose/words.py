"""Findings in words: one, and many of them in one sentence."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable

from cobotwire.diagnose.findings import (
    Boot,
    CommandError,
    DamagedFrame,
    Finding,
    Garbage,
    Nuls,
    OtherWay,
    Panic,
    ServoPacket,
    Text,
    UnlistedFrame,
    Unrecognised,
)

# So many characters of a text, or bytes of something unknown, are shown.
SHOWN = 60
_BROADCAST = 0xFE
_DAMAGE = {
    "bad-length": "its LEN is wrong",
    "bad-check": "it does not end where it must",
    "truncated": "it breaks off",
}
_ERRORS = {0: "voltage", 1: "sensor", 2: "temperature", 3: "current", 5: "overload"}


def words(finding: Finding) -> str:
    """What a finding says, on one line."""
    match finding:
        case ServoPacket():
            return f"servo bus: {_servo(finding)}{_doubt(finding)}"
        case Text():
            return f"text: {shown(finding.text)}"
        case CommandError():
            return "the firmware says cmd_len error: it heard a damaged request, or two at once"
        case Panic():
            return _panic(finding)
        case Boot():
            return f"the controller boots: {finding.cause}"
        case Nuls():
            return f"{finding.count} NULs" + (": the controller restarts" if finding.reboot else "")
        case OtherWay() | UnlistedFrame() | DamagedFrame():
            return _frame(finding)
        case Garbage():
            return (
                f"perhaps another baud rate: {finding.fitting} of {len(finding.data)} bytes look "
                f"stretched (random ones would with probability {finding.chance:.2g})"
            )
    return "unrecognised"


def _servo(packet: ServoPacket) -> str:
    """The packet without the word that it is one."""
    servo = "all servos" if packet.servo == _BROADCAST else f"servo {packet.servo}"
    if packet.role == "status":
        where = "" if packet.register is None else f" at {_register(packet)}"
        said = f"answers {packet.parameters.hex(' ')}{where}" if packet.parameters else "answers"
        return f"{servo} {said}{_errors(packet.error or 0)}"
    if packet.servos:
        servo = f"servos {', '.join(map(str, packet.servos))}"
    if packet.register is None:
        rest = f" {packet.parameters.hex(' ')}" if packet.parameters else ""
        return f"{packet.instruction} of {servo}{rest}"
    verb = f"{packet.instruction} {packet.count} bytes at {_register(packet)} of {servo}"
    if packet.instruction in ("write", "reg write"):
        return f"{verb}: {packet.parameters[1:].hex(' ')}"
    return verb


def _register(packet: ServoPacket) -> str:
    name = f" ({packet.register_name})" if packet.register_name else ""
    return f"register 0x{packet.register:02X}{name}"


def _errors(error: int) -> str:
    names = [name for bit, name in _ERRORS.items() if error >> bit & 1]
    return f", with errors: {', '.join(names)}" if names else ""


def _doubt(packet: ServoPacket) -> str:
    return " (or a reply with errors)" if packet.ambiguous else ""


def _panic(panic: Panic) -> str:
    text = f"panic {panic.cause or 'of unknown cause'}"
    if panic.core is not None:
        text += f" on core {panic.core}"
    if panic.pc is not None:
        text += f" at 0x{panic.pc:08x}"
    if panic.backtrace:
        text += f", backtrace of {len(panic.backtrace)}"
    return text + (", rebooting" if panic.rebooting else "")


def _frame(finding: OtherWay | UnlistedFrame | DamagedFrame) -> str:
    match finding:
        case OtherWay(sent=True):
            return f"echo of our own {finding.command}"
        case OtherWay(direction="request"):
            return f"a request, {finding.command}: an echo, or another host"
        case OtherWay():
            return f"a reply, {finding.command}"
        case UnlistedFrame():
            known = f"{finding.command}, not listed that way" if finding.command else "unknown"
            return f"a whole frame with the id 0x{finding.id:02X} ({known})"
    name = finding.command or "frame"
    return f"damaged {name}: {_DAMAGE.get(finding.reason, finding.reason)}"


def shown(text: str) -> str:
    """A text in quotes, its control characters escaped, and cut if it is long."""
    text = text.strip("\r\n")
    return repr(text if len(text) <= SHOWN else text[: SHOWN - 3] + "...")


class Summary:
    """Counts findings, and makes one sentence of them; keeps the first of each kind."""

    def __init__(self, findings: Iterable[Finding] = ()) -> None:
        self.kinds: Counter[str] = Counter()
        self.bytes: Counter[str] = Counter()
        self._first: dict[str, Finding] = {}
        self._reboots = 0
        for finding in findings:
            self.add(finding)

    def add(self, finding: Finding) -> None:
        """Count one; a further piece of a finding counts with its first."""
        kind = finding.kind
        self.bytes[kind] += len(finding.data)
        if finding.continued:
            return
        self.kinds[kind] += 1
        self._first.setdefault(kind, finding)
        self._reboots += isinstance(finding, Nuls) and finding.reboot

    def __str__(self) -> str:
        """All of it, what matters most first; empty if nothing was found."""
        parts = [self._reboot(), self._command_errors()]
        parts += [
            self._several("servo", "servo bus leak: ", "packet"),
            self._several("other-way", "", "frame"),
            self._several("unlisted-frame", "", "frame"),
            self._several("damaged-frame", "", "damaged frame"),
            self._several("garbage", "perhaps another baud rate: ", "stretch"),
            self._several("text", "text: ", "line"),
            self._nuls(),
            self._unrecognised(),
        ]
        return "; ".join(part for part in parts if part)

    def _reboot(self) -> str:
        panics, boots = self.kinds[Panic.kind], self.kinds[Boot.kind]
        panic = self._first.get(Panic.kind)
        cause = f"panic {panic.cause or 'of unknown cause'}" if isinstance(panic, Panic) else ""
        if isinstance(panic, Panic) and not (self._reboots or boots or panic.rebooting):
            return f"the controller failed: {cause}"
        if not (panics or boots or self._reboots):
            return ""
        boot = self._first.get(Boot.kind)
        told = cause or (boot.cause if isinstance(boot, Boot) else "")
        most = max(panics, boots, self._reboots)
        times = "" if most == 1 else f" {most} times"
        return f"the controller rebooted{times}" + (f": {told}" if told else "")

    def _command_errors(self) -> str:
        count = self.kinds[CommandError.kind]
        times = "" if count == 1 else f" {count} times"
        return f"the firmware said cmd_len error{times}" if count else ""

    def _several(self, kind: str, prefix: str, noun: str) -> str:
        count = self.kinds[kind]
        if not count:
            return ""
        first = self._first[kind]
        example = _servo(first) if isinstance(first, ServoPacket) else words(first)
        if isinstance(first, Garbage):
            example = first.data[: SHOWN // 4].hex(" ")
        if isinstance(first, Text):
            example = shown(first.text)
        if count == 1:
            return f"{prefix}{example}"
        return f"{prefix}{count} {noun}{'es' if noun.endswith('h') else 's'}, e.g. {example}"

    def _nuls(self) -> str:
        short = self.kinds[Nuls.kind] - self._reboots
        return "" if short <= 0 else f"{short} short run{'s' * (short != 1)} of NULs"

    def _unrecognised(self) -> str:
        count = self.bytes[Unrecognised.kind]
        return "" if not count else f"{count} unrecognised byte{'s' * (count != 1)}"


def summary(findings: Iterable[Finding]) -> str:
    """One sentence for many findings, such as ``the controller rebooted: panic LoadProhibited``."""
    return str(Summary(findings))
