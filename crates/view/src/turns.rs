//! Who renders: one picture at a time on all threads, in turns. Who has waited longest comes next.
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};

/// Tickets as in a shop.
#[derive(Debug, Default)]
pub(crate) struct Turns {
    tickets: Mutex<Tickets>,
    called: Condvar,
}

#[derive(Debug, Default)]
struct Tickets {
    /// The next that is given out.
    next: u64,
    /// Whose turn it is.
    served: u64,
}

/// It is the holder's turn until this is dropped.
#[derive(Debug)]
pub(crate) struct Turn<'t> {
    turns: &'t Turns,
    ticket: u64,
}

impl Turns {
    fn lock(&self) -> MutexGuard<'_, Tickets> {
        self.tickets.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Waits for a turn.
    pub(crate) fn take(&self) -> Turn<'_> {
        let mut tickets = self.lock();
        let ticket = tickets.next;
        tickets.next += 1;
        while tickets.served != ticket {
            tickets = self.called.wait(tickets).unwrap_or_else(PoisonError::into_inner);
        }
        Turn { turns: self, ticket }
    }
}

impl Turn<'_> {
    /// Whether somebody waits for it to end.
    pub(crate) fn is_awaited(&self) -> bool {
        self.turns.lock().next > self.ticket + 1
    }
}

impl Drop for Turn<'_> {
    fn drop(&mut self) {
        self.turns.lock().served += 1;
        self.turns.called.notify_all();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::{sync::mpsc, thread};

    #[test]
    fn turns_go_round_in_the_order_of_asking() {
        let turns = Turns::default();
        let (sender, order) = mpsc::channel();
        thread::scope(|scope| {
            let first = turns.take();
            assert!(!first.is_awaited());
            for number in 0..3 {
                let (turns, sender) = (&turns, sender.clone());
                let before = turns.lock().next;
                scope.spawn(move || {
                    let turn = turns.take();
                    sender.send(number).expect("somebody listens");
                    drop(turn);
                });
                while turns.lock().next == before {
                    thread::yield_now();
                }
            }
            assert!(first.is_awaited());
            drop(first);
        });
        drop(sender);
        assert_eq!(order.iter().collect::<Vec<i32>>(), [0, 1, 2]);
        assert!(!turns.take().is_awaited());
    }
}
