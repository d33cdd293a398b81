//! Threads of a page: Web Workers that share the program's memory. A browser shares memory on pages that are isolated from other origins. On other pages, work
//! is done in a later turn of the page's single thread.
//!
//! The first thread of a page may not wait: there [`lock`] tries until it has the lock.

use std::cell::{Cell, RefCell};
use std::io;
use std::panic::PanicHookInfo;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, MutexGuard, Once, PoisonError, TryLockError};
use wasm_bindgen::JsValue;
use wasm_bindgen::closure::Closure;
use wasm_bindgen::prelude::wasm_bindgen;
use wasm_bindgen_futures::{JsFuture, spawn_local};

#[wasm_bindgen(module = "/src/platform/page.js")]
extern "C" {
    fn soon() -> js_sys::Promise;
    #[wasm_bindgen(js_name = isFirst)]
    fn is_first() -> bool;
    #[wasm_bindgen(js_name = isIsolated)]
    fn is_isolated() -> bool;
    fn cores() -> usize;
    fn listen(wake: &JsValue, problem: &JsValue);
    #[wasm_bindgen(js_name = startThread)]
    fn start_thread(name: &str, program: JsValue, memory: JsValue, work: usize);
    #[wasm_bindgen(js_name = askForThread)]
    fn ask_for_thread(name: &str, work: usize);
    #[wasm_bindgen(js_name = wakeFirst)]
    fn wake_first();
    #[wasm_bindgen(js_name = tellFirst)]
    fn tell_first(problem: &str);
}

/// Most threads of one pool; each takes some megabytes.
const MAX_POOL_THREADS: usize = 8;

static HAS_THREADS: AtomicBool = AtomicBool::new(false);

static POOL: Once = Once::new();

static PROBLEMS: Mutex<Vec<String>> = Mutex::new(Vec::new());

thread_local! {
    static IS_FIRST: Cell<Option<bool>> = const { Cell::new(None) };
    static WAKER: RefCell<Option<Box<dyn Fn()>>> = const { RefCell::new(None) };
    static ON_PANIC: RefCell<Option<Box<dyn FnOnce(String)>>> = const { RefCell::new(None) };
}

struct Work {
    /// Whether the thread belongs to a pool.
    of_a_pool: bool,
    run: Box<dyn FnOnce() + Send>,
}

/// Whether this thread is the page's first one, which draws.
pub(super) fn on_first_thread() -> bool {
    IS_FIRST.get().unwrap_or_else(|| {
        let first = is_first();
        IS_FIRST.set(Some(first));
        first
    })
}

/// Whether long work runs on threads beside the window.
pub fn has_threads() -> bool {
    HAS_THREADS.load(Ordering::Relaxed)
}

/// Prepares the threads. Call it on the first thread, before other functions of this file.
pub(super) fn begin() {
    HAS_THREADS.store(is_isolated(), Ordering::Relaxed);
    let wake = Closure::<dyn FnMut()>::new(wake_here).into_js_value();
    let problem = Closure::<dyn FnMut(String)>::new(|problem| {
        lock(&PROBLEMS).push(problem);
        wake_here();
    });
    listen(&wake, &problem.into_js_value());
    if has_threads() {
        // Small computations of the first thread itself must not wait for other threads.
        match rayon::ThreadPoolBuilder::new().num_threads(1).use_current_thread().build() {
            Ok(alone) => std::mem::forget(alone),
            Err(error) => tracing::error!("the first thread has no pool of its own: {error}"),
        }
    }
}

/// Makes threads report a panic. Call it after the window has set its own hook, which would treat every panic as the window's.
pub(super) fn watch_panics() {
    let of_the_window = std::panic::take_hook();
    std::panic::set_hook(Box::new(move |info| {
        if on_first_thread() {
            return of_the_window(info);
        }
        let message = message_of(info);
        let place = info.location().map_or_else(String::new, |l| format!(" ({}:{})", l.file(), l.line()));
        match ON_PANIC.take() {
            Some(then) => then(format!("{message}{place}")),
            None => tell_first(&format!("A computation failed: {message}{place}. Reload the page; the scene is kept.")),
        }
    }));
}

fn message_of(info: &PanicHookInfo<'_>) -> String {
    info.payload_as_str().unwrap_or("a panic without a message").to_owned()
}

/// Sets the action of this thread at a panic, with the panic's message. The thread ends afterwards, since a panic can't be caught.
pub fn on_panic(then: impl FnOnce(String) + 'static) {
    ON_PANIC.set(Some(Box::new(then)));
}

/// Locks `mutex`; the first thread spins instead of waiting.
pub fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    if !on_first_thread() {
        return mutex.lock().unwrap_or_else(PoisonError::into_inner);
    }
    loop {
        match mutex.try_lock() {
            Ok(held) => return held,
            Err(TryLockError::Poisoned(held)) => return held.into_inner(),
            Err(TryLockError::WouldBlock) => std::hint::spin_loop(),
        }
    }
}

/// Runs `work` on a thread called `name`, or in a later turn of a page without threads.
/// # Errors
/// None on a page: a thread that the browser can't start becomes a problem.
pub fn spawn(name: &str, work: impl FnOnce() + Send + 'static) -> io::Result<()> {
    if has_threads() {
        begin_thread(name, Work { of_a_pool: false, run: Box::new(work) });
    } else {
        spawn_local(async move {
            // A frame is drawn first, so that the user sees the request.
            let _turn = JsFuture::from(soon()).await;
            work();
        });
    }
    Ok(())
}

fn begin_thread(name: &str, work: Work) {
    let work = Box::into_raw(Box::new(work)) as usize;
    if on_first_thread() {
        start_thread(name, wasm_bindgen::module(), wasm_bindgen::memory(), work);
    } else {
        // The browser starts a thread only while the asking one is idle.
        ask_for_thread(name, work);
    }
}

/// The entry point of a new thread: the work at an address given by [`begin_thread`].
#[wasm_bindgen(js_name = enterThread)]
pub fn enter_thread(work: usize) {
    // SAFETY: `begin_thread` gave the box away; the browser hands its address to one thread, once.
    let work = *unsafe { Box::from_raw(work as *mut Work) };
    if !work.of_a_pool {
        POOL.call_once(|| {
            let builder = rayon::ThreadPoolBuilder::new().num_threads(pool_threads());
            if let Err(error) = builder.spawn_handler(|thread| begin_pool_thread("pool", thread)).build_global() {
                tracing::error!("the pool of threads could not be started: {error}");
            }
        });
    }
    (work.run)();
}

fn pool_threads() -> usize {
    cores().clamp(1, MAX_POOL_THREADS)
}

fn begin_pool_thread(name: &str, thread: rayon::ThreadBuilder) -> io::Result<()> {
    begin_thread(name, Work { of_a_pool: true, run: Box::new(move || thread.run()) });
    Ok(())
}

/// A pool of threads for slow work; `None` on a page without threads.
pub fn pool(name: &'static str) -> Option<rayon::ThreadPool> {
    let builder = rayon::ThreadPoolBuilder::new().num_threads(pool_threads());
    has_threads().then(|| builder.spawn_handler(|thread| begin_pool_thread(name, thread)).build().ok()).flatten()
}

/// A function that draws another frame of the window, from any thread.
#[cfg(feature = "app")]
pub fn waker(ctx: &eframe::egui::Context) -> impl Fn() + Clone + Send + Sync + 'static {
    let ctx = ctx.clone();
    WAKER.set(Some(Box::new(move || ctx.request_repaint())));
    || if on_first_thread() { wake_here() } else { wake_first() }
}

fn wake_here() {
    WAKER.with_borrow(|wake| wake.iter().for_each(|wake| wake()));
}

/// Problems of threads since the last call, as messages for the user.
pub fn problems() -> Vec<String> {
    std::mem::take(&mut *lock(&PROBLEMS))
}
