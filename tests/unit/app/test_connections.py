"""Which connection makes room for a new one."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from recon4_app.network.connections import (
    Connection,
    ConnectionLimits,
    ConnectionTable,
    Phase,
    client_network,
)


class Network:
    """Connections with numbers, and which of them were aborted."""

    def __init__(self, total, per_address):
        self.table = ConnectionTable(ConnectionLimits(total, per_address))
        self.open = {}
        self.aborted = []

    def connect(self, number, address="a", phase=Phase.WAITING):
        connection = Connection(address, accepted_s=number)
        connection.abort = lambda: self.aborted.append(number)
        self.open[number] = connection
        admitted = self.table.admit(connection)
        self.table.move(connection, phase)
        return admitted


def test_the_oldest_waiting_connection_of_the_address_goes_first():
    network = Network(total=10, per_address=3)
    network.connect(0, "b")
    for number in (1, 2, 3, 4):
        assert network.connect(number)

    assert network.aborted == [1]
    assert len(network.table) == 4


def test_in_all_the_oldest_of_any_address_goes_first():
    network = Network(total=3, per_address=3)
    for number, address in enumerate("abcd"):
        assert network.connect(number, address)

    assert network.aborted == [0]


def test_waiting_goes_before_idle_and_idle_before_nothing():
    network = Network(total=3, per_address=3)
    network.connect(0, phase=Phase.IDLE)
    network.connect(1, phase=Phase.ACTIVE)
    network.connect(2, phase=Phase.WAITING)
    assert network.connect(3, phase=Phase.ACTIVE)
    assert network.connect(4, phase=Phase.ACTIVE)

    assert network.aborted == [2, 0]
    assert not network.connect(5), "all others are being worked on"
    assert network.table.counts.rejected == {"address_limit": 1}


def test_one_address_cannot_take_the_room_of_others():
    network = Network(total=4, per_address=2)
    for number in range(4):
        network.connect(number, "attacker", Phase.ACTIVE)
    assert network.connect(10, "other")
    assert network.connect(11, "other")

    assert network.aborted == []


def test_an_idle_connection_that_is_used_again_is_young_again():
    network = Network(total=2, per_address=2)
    network.connect(0, phase=Phase.IDLE)
    network.connect(1, phase=Phase.IDLE)
    network.table.move(network.open[0], Phase.ACTIVE)
    network.table.move(network.open[0], Phase.IDLE)
    network.connect(2)

    assert network.aborted == [1]


def test_young_connections_are_spared_when_asked():
    network = Network(total=9, per_address=9)
    network.connect(5)

    assert not network.table.make_room(accepted_before_s=5.0)
    assert network.table.make_room(accepted_before_s=5.5)


ACTIONS = st.lists(
    st.tuples(
        st.sampled_from(["connect", "move", "remove"]),
        st.integers(0, 30),
        st.sampled_from("abc"),
        st.sampled_from(list(Phase)),
    ),
    max_size=200,
)


@given(ACTIONS)
def test_whatever_happens_the_limits_hold_and_nothing_active_is_closed(actions):
    network = Network(total=6, per_address=3)
    alive = {}
    for number, (action, which, address, phase) in enumerate(actions):
        if action == "connect":
            active = {n for n, one in alive.items() if one.phase is Phase.ACTIVE}
            if network.connect(number, address):
                alive[number] = network.open[number]
            assert not active & set(network.aborted[-2:])
        elif which in network.open and action == "move":
            network.table.move(network.open[which], phase)
        elif which in network.open:
            network.table.remove(network.open[which])
            alive.pop(which, None)
        alive = {n: one for n, one in alive.items() if n not in network.aborted}
        assert set(network.table) == set(alive.values())
        assert len(alive) <= 6
        assert all(sum(one.address == a for one in alive.values()) <= 3 for a in "abc")


@pytest.mark.parametrize(
    ("files", "total", "per_address"), [(20_000, 1024, 256), (256, 64, 32), (64, 16, 8)]
)
def test_the_limits_fit_the_files_a_process_may_open(files, total, per_address):
    limits = ConnectionLimits.within(1024, per_address=256, files=files)

    assert (limits.total, limits.per_address) == (total, per_address)


def test_a_network_of_ipv6_counts_as_one_address():
    assert client_network("2001:db8::1") == client_network("2001:db8::ffff:2")
    assert client_network("fe80::1%eth0") == client_network("fe80::2%eth0")
    assert client_network("::ffff:192.0.2.1") == "192.0.2.1"
